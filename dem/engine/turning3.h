// Rotation, spin and springs of three dimensions in the words of a snapshot.
#pragma once
#include "dem/engine/engine.h"
#include "dem/laws/rolling.h"
#include "dem/snapshot/snapshot.h"
#include "dem/space/body.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

inline double rotational_energy(const Body<3>& b, const RotationOf<3>& rotation,
                                const Inertia<3>& inertia) {
  if (b.inverse_inertia == 0) return 0;
  const Eigen::Vector3d spin = rotation.conjugate() * b.spin;
  return 0.5 * inertia.moments.dot(spin.cwiseProduct(spin));
}

inline void write_rotation(const Body<3>& b, const RotationOf<3>& rotation,
                           const Inertia<3>& inertia, Grain& g) {
  g.orientation = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
  g.angular_velocity = b.spin;
  g.moments = inertia.moments;
  g.spin = b.spin.z();
  g.inertia = inertia.moments.mean();
}

/// Rotation of a new grain, its moments where they are given, and its spin where it may turn.
inline RotationOf<3> read_rotation(const NewGrain& g, const Inertia<3>&) {
  const auto& q = g.orientation;
  return RotationOf<3>(q[0], q[1], q[2], q[3]).normalized();
}
inline void read_moments(const NewGrain& g, Inertia<3>& inertia) {
  const Eigen::Vector3d given(g.moments[0], g.moments[1], g.moments[2]);
  if (given.minCoeff() > 0) inertia.moments = given;
}
inline void read_spin(const NewGrain& g, const Inertia<3>& inertia, Body<3>& b) {
  b.spin = {g.spin_x, g.spin_y, g.spin};
  b.inverse_inertia = 1 / inertia.moments.mean();
}

inline void write_spring(const Eigen::Vector3d& spring, Contact& c) {
  c.spring_vector = spring;
  c.spring = spring.norm();
}
inline void read_spring(const Contact& c, Eigen::Vector3d& spring) { spring = c.spring_vector; }

inline void write_rolling(const RollingMemory<3>& memory, Contact& c) {
  c.rolling_spring = memory.roll;
  c.twisting_spring = memory.twist;
}
inline void read_rolling(const Contact& c, RollingMemory<3>& memory) {
  memory.roll = c.rolling_spring;
  memory.twist = c.twisting_spring;
}

}  // namespace grainfield::dem
