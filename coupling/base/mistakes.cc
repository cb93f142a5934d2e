#include "coupling/base/mistakes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace grainfield::coupling {
namespace {

constexpr std::size_t kMostShown = 20;  // more are those of another kind of file

std::vector<std::string> shown(std::vector<std::string> lines) {
  if (lines.size() <= kMostShown) return lines;
  const std::size_t more = lines.size() - kMostShown;
  lines.resize(kMostShown);
  lines.push_back(fmt::format("{} more mistakes like these", more));
  return lines;
}

}  // namespace

Mistakes::Mistakes(std::vector<std::string> lines)
    : std::invalid_argument(fmt::format("{}", fmt::join(lines, "\n"))), lines_(std::move(lines)) {}

void MistakeList::add(const std::string& line) {
  if (std::find(lines_.begin(), lines_.end(), line) == lines_.end()) lines_.push_back(line);
}

void MistakeList::sort_by_line(const std::string& file) {
  const auto number = [start = file + ":"](const std::string& line) {
    const bool of_file = line.compare(0, start.size(), start) == 0;
    const long at = of_file ? std::strtol(line.c_str() + start.size(), nullptr, 10) : 0;
    return at > 0 ? at : std::numeric_limits<long>::max();
  };
  std::stable_sort(lines_.begin(), lines_.end(), [&](const std::string& a, const std::string& b) {
    return number(a) < number(b);
  });
}

void MistakeList::require_none() const {
  if (lines_.size() == 1) throw std::invalid_argument(lines_.front());
  if (!lines_.empty()) throw Mistakes(shown(lines_));
}

}  // namespace grainfield::coupling
