#include "coupling/import/lines.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "coupling/system/read_input.h"
#include "dem/cannot_read_now.h"

namespace grainfield::coupling {

Lines::Lines(const std::string& file)
    : file_(file), buffer_(std::make_unique_for_overwrite<char[]>(longest)) {
  require_regular_file(file, "a text file");
  errno = 0;
  in_.open(file, std::ios::binary);
  if (!in_) throw std::invalid_argument(fmt::format("{}: {}", file, std::strerror(errno)));
  if (in_.get() == 0x1f && in_.get() == 0x8b)
    throw std::invalid_argument(file + ": is compressed (gzip); unpack it first");
  in_.clear();
  in_.seekg(0);
}

bool Lines::next(std::string_view& line) {
  errno = 0;
  in_.getline(buffer_.get(), static_cast<std::streamsize>(longest));
  std::streamsize count = in_.gcount();
  if (in_.bad()) {
    const std::string after = line_ == 0 ? "" : fmt::format(" on behind line {}", line_);
    throw dem::CannotReadNow(
        fmt::format("{}: cannot be read{}: {}", file_, after,
                    errno != 0 ? std::strerror(errno) : "the system gives no reason"));
  }
  if (count == 0 && in_.eof()) return false;
  ++line_;
  if (in_.fail())
    throw std::invalid_argument(fmt::format(
        "{}: the line is longer than {} bytes; is this a text file?", where(), longest - 1));
  unfinished_ = in_.eof();
  if (!unfinished_) --count;  // the end of line, counted but not stored
  if (count > 0 && buffer_[static_cast<std::size_t>(count) - 1] == '\r') --count;
  line = std::string_view(buffer_.get(), static_cast<std::size_t>(count));
  return true;
}

std::string Lines::where() const { return fmt::format("{}:{}", file_, line_); }

Lines::Place Lines::place() {
  if (in_.eof()) in_.clear();
  return {static_cast<std::streamoff>(in_.tellg()), line_};
}

void Lines::seek(const Place& place) {
  in_.clear();
  in_.seekg(place.offset);
  line_ = place.line;
}

std::string_view trimmed(std::string_view text) {
  const char* space = " \t";
  const std::size_t first = text.find_first_not_of(space);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(space) - first + 1);
}

void split(std::string_view line, char separator, std::vector<std::string_view>& parts) {
  parts.clear();
  const bool white = separator == ' ';
  std::size_t at = 0;
  while (true) {
    if (white) at = std::min(line.find_first_not_of(" \t", at), line.size());
    if (white && at == line.size()) return;
    const std::size_t end =
        std::min(white ? line.find_first_of(" \t", at) : line.find(separator, at), line.size());
    std::string_view part = trimmed(line.substr(at, end - at));
    if (part.size() >= 2 && part.front() == '"' && part.back() == '"')
      part = part.substr(1, part.size() - 2);
    parts.push_back(part);
    if (end == line.size()) return;
    at = end + 1;
  }
}

}  // namespace grainfield::coupling
