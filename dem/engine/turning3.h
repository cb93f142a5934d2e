// Rotation, spin and springs of three dimensions in the words of a snapshot.
#pragma once
#include "dem/engine/engine.h"
#include "dem/snapshot/snapshot.h"
#include "dem/space/body.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

inline double turning_energy(const Body<3>& b, const RotationOf<3>& rotation,
                             const Inertia<3>& inertia) {
  if (b.inverse_inertia == 0) return 0;
  const Eigen::Vector3d spin = rotation.conjugate() * b.spin;
  return 0.5 * inertia.moments.dot(spin.cwiseProduct(spin));
}

inline void tell_turning(const Body<3>& b, const RotationOf<3>& rotation, const Inertia<3>& inertia,
                         Grain& g) {
  g.orientation = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
  g.angular_velocity = b.spin;
  g.moments = inertia.moments;
  g.spin = b.spin.z();
  g.inertia = inertia.moments.mean();
}

/// Rotation of a new grain, and its spin and moment where it may turn.
inline RotationOf<3> rotation_told(const NewGrain& g, const Inertia<3>&) {
  const auto& q = g.orientation;
  return RotationOf<3>(q[0], q[1], q[2], q[3]).normalized();
}
inline void take_turning(const NewGrain& g, const Inertia<3>& inertia, Body<3>& b) {
  b.spin = {g.spin_x, g.spin_y, g.spin};
  b.inverse_inertia = 1 / inertia.moments.mean();
}

inline void tell_spring(const Eigen::Vector3d& spring, Contact& c) {
  c.spring_vector = spring;
  c.spring = spring.norm();
}
inline void take_spring(const Contact& c, Eigen::Vector3d& spring) { spring = c.spring_vector; }

}  // namespace grainfield::dem
