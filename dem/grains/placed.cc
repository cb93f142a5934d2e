#include "dem/grains/placed.h"

#include <algorithm>
#include <limits>

#include "dem/space/rotation.h"

namespace grainfield::dem {

Outline placed_outline(const Grain& g) {
  Outline out = g.outline;
  const auto [c, s] = rotation_of(g.angle);
  for (auto& p : out) {
    p = {g.position.x() + c * p[0] - s * p[1], g.position.y() + s * p[0] + c * p[1]};
  }
  return out;
}

double top_of(const Grain& g) {
  if (g.outline.empty()) return g.position.y() + g.radius;
  double top = -std::numeric_limits<double>::infinity();
  for (const auto& p : placed_outline(g)) top = std::max(top, p[1]);
  return top;
}

}  // namespace grainfield::dem
