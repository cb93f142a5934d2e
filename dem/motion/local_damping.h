// Cundall's local damping (Cundall 1987): against every component of the motion a share of the
// force that acts along it.
//
//   F_k -= alpha |F_k| sgn(v_k),   M_k -= alpha |M_k| sgn(w_k)
//
// F is all that acts on the grain, with its weight, so the damping vanishes where forces balance:
// it moves no equilibrium. It depends on the axes. The same rule as LAMMPS' fix damping/cundall and
// YADE's NewtonIntegrator; v is the velocity of the half step.
#pragma once
#include "dem/space/space.h"

namespace grainfield::dem {

inline double local_damping(double force, double velocity, double alpha) {
  if (velocity > 0) return -alpha * std::fabs(force);
  if (velocity < 0) return alpha * std::fabs(force);
  return 0;
}
/// The damping force (N; of a moment and a spin N m), alpha in [0, 1).
template <class Vector>
requires(!std::is_arithmetic_v<Vector>) Vector
    local_damping(const Vector& force, const Vector& velocity, double alpha) {
  Vector out = zero<Vector>();
  for (int k = 0; k < Vector::RowsAtCompileTime; ++k)
    out[k] = local_damping(force[k], velocity[k], alpha);
  return out;
}

}  // namespace grainfield::dem
