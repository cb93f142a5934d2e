// Rotation, spin and springs of two dimensions in the words of a snapshot.
#pragma once
#include "dem/laws/contact.h"
#include "dem/snapshot/snapshot.h"
#include "dem/space/body.h"

namespace grainfield::dem {

inline double turning_energy(const Body<2>& b, double /*rotation*/, const Inertia<2>&) {
  return b.inverse_inertia > 0 ? 0.5 * b.spin * b.spin / b.inverse_inertia : 0.0;
}

inline void tell_turning(const Body<2>& b, double rotation, const Inertia<2>& inertia, Grain& g) {
  g.angle = rotation;
  g.spin = b.spin;
  g.inertia = inertia.moments;
}

inline void tell_spring(const SpringMemory<2>& memory, Contact& c) { c.spring = memory.spring; }
inline SpringMemory<2> spring_told(const Contact& c, const SpringMemory<2>*) { return {c.spring}; }

}  // namespace grainfield::dem
