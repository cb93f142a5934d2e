// Rotation, spin and springs of two dimensions in the words of a snapshot.
#pragma once
#include "dem/engine/engine.h"
#include "dem/laws/rolling.h"
#include "dem/snapshot/snapshot.h"
#include "dem/space/body.h"

namespace grainfield::dem {

inline double rotational_energy(const Body<2>& b, double /*rotation*/, const Inertia<2>&) {
  return b.inverse_inertia > 0 ? 0.5 * b.spin * b.spin / b.inverse_inertia : 0.0;
}

inline void write_rotation(const Body<2>& b, double rotation, const Inertia<2>& inertia, Grain& g) {
  g.angle = rotation;
  g.spin = b.spin;
  g.inertia = inertia.moments;
}

/// Rotation of a new grain, its moments where they are given, and its spin where it may turn.
inline double read_rotation(const NewGrain& g, const Inertia<2>&) { return g.angle; }
inline void read_moments(const NewGrain& g, Inertia<2>& inertia) {
  if (g.moments[2] > 0) inertia.moments = g.moments[2];
}
inline void read_spin(const NewGrain& g, const Inertia<2>& inertia, Body<2>& b) {
  b.spin = g.spin;
  b.inverse_inertia = 1 / inertia.moments;
}

inline void write_spring(double spring, Contact& c) { c.spring = spring; }
inline void read_spring(const Contact& c, double& spring) { spring = c.spring; }

/// Writes memories of a contact whose normal is known, as vectors and numbers that are the same
/// seen from either grain.
inline void write_rolling(const RollingMemory<2>& memory, Contact& c) {
  c.rolling_spring = memory.roll * Vec3(-c.normal.y(), c.normal.x(), 0);
}
inline void read_rolling(const Contact& c, RollingMemory<2>& memory) {
  memory.roll = c.rolling_spring.y() * c.normal.x() - c.rolling_spring.x() * c.normal.y();
}

}  // namespace grainfield::dem
