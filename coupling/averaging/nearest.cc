#include "coupling/averaging/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace grainfield::coupling {
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

std::string unknown_name(const std::string& what, const std::string& found,
                         const std::vector<std::string>& known) {
  std::string text = fmt::format("unknown {} \"{}\"", what, found);
  if (known.empty()) return text + "; there is none";
  const auto nearest =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
        return edit_distance(found, a) < edit_distance(found, b);
      });
  return text + fmt::format("; known: {}; did you mean \"{}\"?", fmt::join(known, ", "), *nearest);
}

}  // namespace grainfield::coupling
