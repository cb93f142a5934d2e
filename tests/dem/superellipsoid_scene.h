// Superellipsoids where a test wants them.
#pragma once
#include <cmath>
#include <numbers>

#include "dem/random/random.h"
#include "dem/shapes/superellipsoid.h"

namespace grainfield::dem {

/// Semi-axes in (0.5, 1.5) as Wellmann's, exponents in the range given.
inline Superellipsoid random_superellipsoid(Random& random, double least, double most) {
  std::array<double, 3> axes{};
  for (double& r : axes) r = random.uniform(0.5, 1.5);
  const double e1 = random.uniform(least, most);
  return superellipsoid(axes, {e1, random.uniform(least, most)});
}

/// Uniform on the unit sphere.
inline Eigen::Vector3d random_direction(Random& random) {
  const double z = random.uniform(-1, 1), angle = random.uniform(0, 2 * std::numbers::pi);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Uniform (Shoemake 1992).
inline RotationOf<3> random_rotation(Random& random) {
  const double u = random.uniform(), a = random.uniform(0, 2 * std::numbers::pi),
               b = random.uniform(0, 2 * std::numbers::pi);
  return {std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
          std::sqrt(u) * std::sin(b), std::sqrt(u) * std::cos(b)};
}

}  // namespace grainfield::dem
