// What every contact law takes and gives, and the friction that all share.
#pragma once
#include <algorithm>
#include <cmath>

#include "dem/space/overlap.h"

namespace grainfield::dem {

/// Motion and inertia at a contact.
struct ContactMotion {
  double approach = 0;  ///< closing speed along the normal, m/s
  double slip = 0;      ///< velocity of i relative to j along (-n_y, n_x), m/s
  double inverse_mass_i = 0, inverse_mass_j = 0;
  double inverse_inertia_i = 0, inverse_inertia_j = 0;
};

/// Forces of a contact: `normal` >= 0 repels; `tangential` acts on i along (-n_y, n_x).
struct LawForce {
  double normal = 0;
  double tangential = 0;
};

/// A contact counts as sliding when its tangential force is within this share of the Coulomb limit.
inline constexpr double kSlidingMargin = 1e-6;

/// Cundall-Strack friction. The spring (the contact's memory, in N, as a force on i) advances by
/// -stiffness * slip * dt; the dashpot acts beside it and never accumulates in it; the sum is
/// capped at mu * normal, and then the spring is what the cap leaves for it, itself within the cap.
/// Returns the tangential force on i.
inline double friction_force(double normal, double mu, double stiffness, double viscosity,
                             double slip, double dt, double& spring) {
  const double limit = mu * normal;
  const double viscous = -viscosity * slip;
  const double trial = spring - stiffness * slip * dt;
  const double sum = trial + viscous;
  const double force = std::min(std::max(sum, -limit), limit);
  const double rest = force == sum ? trial : force - viscous;
  spring = std::min(std::max(rest, -limit), limit);
  return force;
}

}  // namespace grainfield::dem
