// A shape as it is given, and what its size makes of a grain.
#pragma once
#include <array>
#include <numbers>

#include "dem/space/outline.h"
#include "dem/space/space.h"

namespace grainfield::dem {

/// What is given of a grain's shape.
struct ShapeInput {
  double radius = 0;                      ///< m; of a polygon: not used
  const Outline& outline;                 ///< body frame; empty: round
  std::array<double, 3> axes{};           ///< of a superellipsoid: semi-axes, m
  std::array<double, 2> exponents{1, 1};  ///< of a superellipsoid: e1, e2
};

/// Bounding radius, volume and moments at density 1.
template <int D>
struct Solid {
  double radius = 0;  ///< from the centroid to the farthest point, m
  double volume = 0;  ///< m3; m2 in 2D
  typename Space<D>::Moments moments = zero<typename Space<D>::Moments>();
};

inline Solid<2> disk_solid(double radius) {
  const double area = std::numbers::pi * radius * radius;
  return {radius, area, 0.5 * area * radius * radius};
}

}  // namespace grainfield::dem
