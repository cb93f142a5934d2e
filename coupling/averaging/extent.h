// How far a grain reaches. The one place of averaging that knows how an outline is placed.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "dem/grains/reach.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Largest extent of the grain from its centroid along the unit direction (dx, dy), m.
inline double reach_along(const dem::Grain& grain, double dx, double dy) {
  if (grain.outline.empty()) return grain.radius;
  const double c = std::cos(grain.angle), s = std::sin(grain.angle);
  const double bx = c * dx + s * dy, by = -s * dx + c * dy;  // in the body frame
  double reach = 0;
  for (const auto& [x, y] : grain.outline) reach = std::max(reach, x * bx + y * by);
  return reach;
}

/// Heights and abscissas of a grain's edges in the plane, m.
inline double top_of(const dem::Grain& grain) {
  return grain.position.y() + reach_along(grain, 0, 1);
}
inline double bottom_of(const dem::Grain& grain) {
  return grain.position.y() - reach_along(grain, 0, -1);
}
/// The same in space, where up is z.
inline double top_of(const dem::Grain& grain, int dim) {
  return dim == 2 ? top_of(grain) : dem::top_3d(grain);
}
inline double bottom_of(const dem::Grain& grain, int dim) {
  return dim == 2 ? bottom_of(grain) : dem::bottom_3d(grain);
}
/// The axis along which height is measured: y in the plane, z in space.
inline int up_axis(int dim) { return dim - 1; }
inline double left_of(const dem::Grain& grain) {
  return grain.position.x() - reach_along(grain, -1, 0);
}
inline double right_of(const dem::Grain& grain) {
  return grain.position.x() + reach_along(grain, 1, 0);
}

/// The grain's corners where they are, counter-clockwise, m; empty: a disk.
inline std::vector<Eigen::Vector2d> placed_outline(const dem::Grain& grain) {
  std::vector<Eigen::Vector2d> out;
  out.reserve(grain.outline.size());
  const double c = std::cos(grain.angle), s = std::sin(grain.angle);
  for (const auto& [x, y] : grain.outline)
    out.emplace_back(grain.position.x() + c * x - s * y, grain.position.y() + s * x + c * y);
  return out;
}

}  // namespace grainfield::coupling
