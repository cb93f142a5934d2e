#include "coupling/app/threads_option.h"

#include <fmt/format.h>

#include <charconv>

namespace grainfield::coupling {
namespace {

constexpr int kMostThreads = 1024;

std::string complaint(const std::string& text) {
  int threads = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), threads);
  const bool good = error == std::errc() && stop == text.data() + text.size() && threads >= 1 &&
                    threads <= kMostThreads;
  return good ? "" : fmt::format("found {}, allowed: 1 to {}", text, kMostThreads);
}

}  // namespace

void add_threads(CLI::App& command, int& threads, const std::string& meaning) {
  command.add_option("--threads", threads, meaning)->check(CLI::Validator(complaint, ""));
}

}  // namespace grainfield::coupling
