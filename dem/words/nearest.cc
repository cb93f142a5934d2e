#include "dem/words/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace grainfield::dem {
namespace {

// Levenshtein distance by the usual two-row recurrence.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_of(const std::string& found, const std::vector<std::string>& known) {
  return *std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return edit_distance(found, a) < edit_distance(found, b);
  });
}

void refuse_word(const std::string& key, const std::string& found,
                 const std::vector<std::string>& allowed) {
  throw std::invalid_argument(fmt::format("{}: found \"{}\", allowed: {}; did you mean \"{}\"?",
                                          key, found, fmt::join(allowed, ", "),
                                          nearest_of(found, allowed)));
}

void check_word(const std::string& key, const std::string& found,
                const std::vector<std::string>& allowed) {
  if (std::find(allowed.begin(), allowed.end(), found) == allowed.end())
    refuse_word(key, found, allowed);
}

}  // namespace grainfield::dem
