#include "coupling/app/threads_option.h"

#include <fmt/format.h>

#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

constexpr int kMostThreads = 1024;

std::string complaint(const std::string& text) {
  const std::optional<long long> threads = dem::parse_integer(text);
  const bool good = threads && *threads >= 1 && *threads <= kMostThreads;
  return good ? "" : fmt::format("found {}, allowed: 1 to {}", text, kMostThreads);
}

}  // namespace

void add_threads(CLI::App& command, int& threads, const std::string& meaning) {
  command.add_option("--threads", threads, meaning)->check(CLI::Validator(complaint, ""));
}

}  // namespace grainfield::coupling
