// Whether a grain of one state is that of another.
#pragma once
#include <algorithm>
#include <cmath>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Sizes of one grain in two states differ by less, relative to its radius: files written with six
/// digits, and radii that follow from rounded outlines.
inline constexpr double kSameSize = 1e-5;

inline bool same_radius(const Grain& a, const Grain& b) {
  return std::abs(a.radius - b.radius) <= kSameSize * std::max(a.radius, b.radius);
}

/// Corners in the grain's own axes.
inline bool same_outline(const Grain& a, const Grain& b) {
  const double near = kSameSize * std::max(a.radius, b.radius);
  return std::equal(a.outline.begin(), a.outline.end(), b.outline.begin(), b.outline.end(),
                    [near](const auto& p, const auto& q) {
                      return std::hypot(p[0] - q[0], p[1] - q[1]) <= near;
                    });
}

}  // namespace grainfield::dem
