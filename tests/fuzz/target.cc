#include "tests/fuzz/target.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "coupling/base/failure.h"

namespace grainfield::fuzz {
namespace {

std::vector<Target>& list() {
  static std::vector<Target> all;
  return all;
}

// What std:: says by itself, such as "stod", is one word.
bool tells_nothing(const std::string& text) { return text.find(' ') == std::string::npos; }

}  // namespace

const std::vector<Target>& targets() { return list(); }

const Target& find_target(const std::string& name) {
  std::vector<std::string> names;
  for (const Target& target : list()) {
    if (target.name == name) return target;
    names.push_back(target.name);
  }
  throw std::invalid_argument(
      fmt::format("target: found \"{}\", allowed: {}", name, fmt::join(names, ", ")));
}

Registration::Registration(const char* name, void (*run)(std::string_view bytes)) {
  const auto later = [&](const Target& other) { return other.name > name; };
  list().insert(std::find_if(list().begin(), list().end(), later), {name, run});
}

void attempt(const std::function<void()>& read) {
  coupling::Failure failure;
  try {
    read();
    return;
  } catch (...) {
    failure = coupling::failure_of(std::current_exception());
  }
  if (failure.code != 2 && failure.code != 3) {
    throw std::logic_error(fmt::format("exit code {}: {}", failure.code, failure.text));
  }
  if (tells_nothing(failure.text)) {
    throw std::logic_error(fmt::format("a message that tells nothing: \"{}\"", failure.text));
  }
}

InputFile::InputFile(std::string_view bytes)
    : path_((std::filesystem::temp_directory_path() / "input_XXXXXX").string()) {
  const int descriptor = mkstemp(path_.data());
  std::size_t written = 0;
  while (descriptor >= 0 && written < bytes.size()) {
    const ssize_t n = write(descriptor, bytes.data() + written, bytes.size() - written);
    if (n <= 0) break;
    written += static_cast<std::size_t>(n);
  }
  if (descriptor >= 0) close(descriptor);
  if (descriptor < 0 || written < bytes.size()) throw std::runtime_error("no temporary file");
  // The look ahead at an HDF5 file takes place once for one that is not young (trial_read.h).
  const auto now = std::filesystem::file_time_type::clock::now();
  std::filesystem::last_write_time(path_, now - std::chrono::hours(1));
}

InputFile::~InputFile() { unlink(path_.c_str()); }

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace grainfield::fuzz
