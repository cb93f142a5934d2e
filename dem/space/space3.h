// Three dimensions: spin and torque are vectors, a rotation is a unit quaternion.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dem/space/rotation.h"
#include "dem/space/space.h"

namespace grainfield::dem {

template <>
struct Space<3> {
  using Vector = Eigen::Vector3d;
  using Spin = Eigen::Vector3d;
  using Tangential = Eigen::Vector3d;  ///< perpendicular to the normal
  using Rotation = Eigen::Quaternion<double, Eigen::DontAlign>;
  using Moments = Eigen::Vector3d;  ///< principal moments, about the axes of the body frame

  static double angle_between(const Rotation& a, const Rotation& b) { return a.angularDistance(b); }
};

/// The rotation by `turn` (rad, its direction the axis), the same bits on every machine.
inline RotationOf<3> quaternion_of(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (!(angle > 0)) return RotationOf<3>::Identity();
  const dem::Rotation half = rotation_of(0.5 * angle);
  const Eigen::Vector3d v = (half.sine / angle) * turn;
  return {half.cosine, v.x(), v.y(), v.z()};
}

}  // namespace grainfield::dem
