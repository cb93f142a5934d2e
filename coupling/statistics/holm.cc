#include "coupling/statistics/holm.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace grainfield::coupling {

std::vector<double> holm(const std::vector<double>& p_values) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < p_values.size(); ++k)
    if (!std::isnan(p_values[k])) order.push_back(k);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> out = p_values;
  double least = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double times = static_cast<double>(order.size() - k);
    least = std::max(least, std::min(1.0, times * p_values[order[k]]));
    out[order[k]] = least;
  }
  return out;
}

}  // namespace grainfield::coupling
