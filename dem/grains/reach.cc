#include "dem/grains/reach.h"

#include <Eigen/Geometry>

#include "dem/shapes/superellipsoid.h"

namespace grainfield::dem {

double reach_along(const Grain& grain, const Vec3& n) {
  if (grain.axes.isZero(0)) return grain.radius;
  const auto& q = grain.orientation;
  const Eigen::Quaterniond turned(q[0], q[1], q[2], q[3]);
  const Superellipsoid body =
      superellipsoid({grain.axes.x(), grain.axes.y(), grain.axes.z()}, grain.exponents);
  return height_of(body, turned.conjugate() * Eigen::Vector3d(n));
}

double top_3d(const Grain& grain) { return grain.position.z() + reach_along(grain, Vec3(0, 0, 1)); }
double bottom_3d(const Grain& grain) {
  return grain.position.z() - reach_along(grain, Vec3(0, 0, -1));
}

}  // namespace grainfield::dem
