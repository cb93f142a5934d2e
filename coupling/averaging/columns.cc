#include "coupling/averaging/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace grainfield::coupling {

std::size_t count_columns(const dem::Snapshot& snapshot, int axis, double from, double to,
                          double column, double most) {
  const double count = std::max(1.0, std::floor((to - from) / column));
  if (count <= most) return static_cast<std::size_t>(count);
  std::vector<double> places;
  for (const dem::Grain& g : snapshot.grains) {
    if (!g.fixed) places.push_back(g.position[axis]);
  }
  if (places.empty()) throw std::invalid_argument("the snapshot has no free grain");
  const double middle = boost::math::statistics::median(places);
  const dem::Grain* furthest = nullptr;
  for (const dem::Grain& g : snapshot.grains) {
    if (g.fixed) continue;
    if (furthest == nullptr ||
        std::fabs(g.position[axis] - middle) > std::fabs(furthest->position[axis] - middle)) {
      furthest = &g;
    }
  }
  throw std::invalid_argument(fmt::format(
      "grain {} at {} = {:g} m has gone astray: the packing, with its middle at {:g} m, would have "
      "{:.3g} columns of {:.3g} m, allowed: up to {:g}",
      furthest->id, "xyz"[axis], furthest -> position[axis], middle, count, column, most));
}

}  // namespace grainfield::coupling
