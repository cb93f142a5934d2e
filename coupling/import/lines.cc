#include "coupling/import/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace grainfield::coupling {

namespace {
constexpr std::size_t kBlock = std::size_t{1} << 16;  // bytes that are read at once

struct Sign {
  std::string_view bytes, plain;  // of one length
};
// What typesetting, spreadsheets and DOS put in the place of blanks and of the minus of a number:
// no-break and narrow blanks, a byte order mark of a file that was put behind another, Ctrl-Z.
constexpr std::array kSigns{Sign{"\xC2\xA0", "  "},      Sign{"\xE2\x80\xAF", "   "},
                            Sign{"\xE2\x80\x89", "   "}, Sign{"\xEF\xBB\xBF", "   "},
                            Sign{"\xE2\x88\x92", "  -"}, Sign{"\x1A", " "}};

}  // namespace

Lines::Lines(const std::string& file) : file_(file), source_(file) {}

bool Lines::fill() {
  if (ended_) return false;
  buffer_.erase(0, at_);
  start_ += static_cast<std::streamoff>(at_);
  at_ = 0;
  const std::size_t old = buffer_.size();
  // One block is all that is kept of short lines.
  const std::size_t more = old < kBlock / 2 ? kBlock - old : kBlock;
  buffer_.resize(old + more);
  const std::size_t count = source_.read(buffer_.data() + old, more);
  buffer_.resize(old + count);
  ended_ = count == 0;
  // From the last bytes of the block before, where a sign may begin.
  for (const Sign& sign : kSigns)
    for (std::size_t at = old - std::min(old, sign.bytes.size() - 1);
         (at = buffer_.find(sign.bytes, at)) != std::string::npos; at += sign.bytes.size())
      buffer_.replace(at, sign.bytes.size(), sign.plain);
  return !ended_;
}

Lines::End Lines::find_end() const {
  const std::size_t feed = buffer_.find('\n', at_);
  const std::string_view line(buffer_.data() + at_, std::min(feed, buffer_.size()) - at_);
  const std::size_t turn = line.find('\r');
  if (turn == std::string_view::npos) return {feed, feed + 1};
  // "\r\n", and what was made of it by those who put a "\r" before every "\n" once more.
  const std::size_t rest = line.find_first_not_of('\r', turn);
  if (rest != std::string_view::npos) return {at_ + turn, at_ + turn + 1};
  if (feed != std::string::npos) return {at_ + turn, feed + 1};
  return ended_ ? End{at_ + turn, at_ + turn + 1} : End{};
}

bool Lines::next(std::string_view& line) {
  End end;
  while (true) {
    end = find_end();
    const std::size_t length = std::min(end.text, buffer_.size()) - at_;
    if (length >= longest) {
      ++line_;
      throw std::invalid_argument(fmt::format(
          "{}: the line is longer than {} bytes; is this a text file?", where(), longest - 1));
    }
    if (end.text != std::string::npos || !fill()) break;
  }
  if (end.text == std::string::npos) end = find_end();
  if (end.text == std::string::npos && at_ == buffer_.size()) return false;
  ++line_;
  unfinished_ = end.text == std::string::npos;
  if (unfinished_) end = {buffer_.size(), buffer_.size()};
  line = std::string_view(buffer_).substr(at_, end.text - at_);
  at_ = end.next;
  return true;
}

std::string Lines::where() const { return fmt::format("{}:{}", file_, line_); }

void Lines::seek(const Place& place) {
  line_ = place.line;
  const auto last = start_ + static_cast<std::streamoff>(buffer_.size());
  if (place.offset >= start_ && place.offset <= last) {
    at_ = static_cast<std::size_t>(place.offset - start_);
    return;
  }
  source_.seek(place.offset);
  buffer_.clear();
  start_ = place.offset;
  at_ = 0;
  ended_ = false;
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
    std::size_t end =
        std::min(white ? line.find_first_of(" \t", at) : line.find(separator, at), line.size());
    // "Particle Identifier" in quotation marks, between blanks.
    if (white && line[at] == '"') {
      const std::size_t close = line.find('"', at + 1);
      const bool whole =
          close != std::string_view::npos &&
          (close + 1 == line.size() || line.find_first_of(" \t", close) == close + 1);
      if (whole) end = close + 1;
    }
    std::string_view part = trimmed(line.substr(at, end - at));
    if (part.size() >= 2 && part.front() == '"' && part.back() == '"')
      part = part.substr(1, part.size() - 2);
    parts.push_back(part);
    if (end == line.size()) return;
    at = end + 1;
  }
}

}  // namespace grainfield::coupling
