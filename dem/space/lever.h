// omega x r, r x F and the power of a torque, of two and of three dimensions under one name.
#pragma once
#include "dem/space/space.h"

namespace grainfield::dem {

/// Velocity that a spin gives a point at `arm`: omega x r.
inline PlainVector<2> velocity_at(double spin, const PlainVector<2>& arm) {
  return {-spin * arm.y(), spin * arm.x()};
}
inline Eigen::Vector3d velocity_at(const Eigen::Vector3d& spin, const Eigen::Vector3d& arm) {
  return {spin.y() * arm.z() - spin.z() * arm.y(), spin.z() * arm.x() - spin.x() * arm.z(),
          spin.x() * arm.y() - spin.y() * arm.x()};
}

/// r x F.
inline double torque_of(const PlainVector<2>& arm, const PlainVector<2>& force) {
  return arm.x() * force.y() - arm.y() * force.x();
}
inline Eigen::Vector3d torque_of(const Eigen::Vector3d& arm, const Eigen::Vector3d& force) {
  return velocity_at(arm, force);
}

/// Power of a torque on a body that spins.
inline double power_of(double torque, double spin) { return torque * spin; }
inline double power_of(const Eigen::Vector3d& torque, const Eigen::Vector3d& spin) {
  return torque.dot(spin);
}

/// A spin or torque as a vector in space, and back.
inline Eigen::Vector3d turning_to_three(double value) { return {0, 0, value}; }
inline Eigen::Vector3d turning_to_three(const Eigen::Vector3d& value) { return value; }
template <int D>
SpinOf<D> turning_in_space(const Eigen::Vector3d& value) {
  if constexpr (D == 2)
    return value.z();
  else
    return value;
}

}  // namespace grainfield::dem
