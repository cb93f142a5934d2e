// A grain that lies on a floor and slides, until friction has made it roll.
#pragma once
#include "dem/collisions/impulse.h"
#include "dem/space/lever.h"

namespace grainfield::dem {

template <int D>
struct Sliding {
  VectorOf<D> acceleration = zero<VectorOf<D>>();  ///< m/s2
  SpinOf<D> turning = zero<SpinOf<D>>();           ///< rad/s2
  double time = 0;                                 ///< until it rolls, s; 0: it does already
};

/// Slides a grain on the plane with that unit normal, which presses with `gravity` (m/s2) times its
/// mass: friction mu m g acts against its slip s, which falls at mu m g (1/m + r^2/I), as long as
/// there is any. Slip below `least` of the speeds is none.
template <int D>
Sliding<D> sliding_of(const Body<D>& grain, const VectorOf<D>& normal, double gravity,
                      double friction, double least) {
  Sliding<D> out;
  const VectorOf<D> arm = -grain.radius * normal;
  VectorOf<D> slip = grain.velocity + velocity_at(grain.spin, arm);
  slip -= slip.dot(normal) * normal;
  const double size = slip.norm();
  if (friction == 0 ||
      size <= least * (grain.velocity.norm() + grain.radius * size_of(grain.spin))) {
    return out;
  }
  const double load = friction * gravity / grain.inverse_mass;
  const VectorOf<D> force = (-load / size) * slip;
  const double inverse = grain.inverse_mass + grain.radius * grain.radius * grain.inverse_inertia;
  out.acceleration = grain.inverse_mass * force;
  out.turning = grain.inverse_inertia * torque_of(arm, force);
  out.time = size / (load * inverse);
  return out;
}

}  // namespace grainfield::dem
