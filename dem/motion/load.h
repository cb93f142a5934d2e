// What a body's motion follows from, as every integrator takes it.
#pragma once
#include "dem/space/body.h"

namespace grainfield::dem {

template <int D>
struct Load {
  VectorOf<D> force = zero<VectorOf<D>>();    ///< N
  SpinOf<D> torque = zero<SpinOf<D>>();       ///< about the centroid, N m
  VectorOf<D> gravity = zero<VectorOf<D>>();  ///< m/s2
  double drag = 0;  ///< 1/s; acceleration -= drag * velocity, turning likewise
};

template <int D>
VectorOf<D> acceleration_of(const Body<D>& b, const Load<D>& load) {
  return load.force * b.inverse_mass + load.gravity - load.drag * b.velocity;
}

/// Angular acceleration in the plane, rad/s2.
inline double spin_rate_of(const Body<2>& b, const Load<2>& load) {
  return load.torque * b.inverse_inertia - load.drag * b.spin;
}

/// Angular momentum in the plane, kg m2/s; 0 of a body that does not turn.
inline double angular_momentum_of(const Body<2>& b, double /*rotation*/, const Inertia<2>&) {
  return b.inverse_inertia > 0 ? b.spin / b.inverse_inertia : 0.0;
}

}  // namespace grainfield::dem
