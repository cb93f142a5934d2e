#include "coupling/observe/observations.h"

#include <fmt/format.h>

#include <stdexcept>

namespace grainfield::coupling {

void keep_complete_rows(const FitData& all, const std::string& key, const std::string& advice,
                        Observations& out) {
  constexpr std::size_t kLeastRows = 10;
  std::vector<int> kept;
  for (int k = 0; k < all.values(); ++k) {
    if (all.samples.row(k).allFinite()) kept.push_back(k);
  }
  out.left_out += all.values() - static_cast<int>(kept.size());
  if (kept.size() < kLeastRows) {
    throw std::invalid_argument(
        fmt::format("{}: found {} values in the {}, needed: {} or more; {}", key, kept.size(),
                    out.specimen == Specimen::heap ? "heaps" : "layers", kLeastRows, advice));
  }
  out.data = rows_of(all, kept);
  out.realizations = out.data.realizations();
}

}  // namespace grainfield::coupling
