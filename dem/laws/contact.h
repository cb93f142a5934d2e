// What every contact law takes and gives, and the friction that all share.
#pragma once
#include <algorithm>
#include <cmath>

#include "dem/space/kinematics.h"
#include "dem/space/overlap.h"

namespace grainfield::dem {

/// Forces of a contact: `normal` >= 0 repels; `tangential` acts on i (in 2D along (-n_y, n_x)).
template <int D>
struct LawForce {
  double normal = 0;
  TangentialOf<D> tangential = zero<TangentialOf<D>>();
};

/// Elastic energy of a contact, J.
struct ContactEnergy {
  double normal = 0;      ///< of the overlap
  double tangential = 0;  ///< in the spring of friction

  double total() const { return normal + tangential; }
};

/// Energy of a spring of friction with a force, N (number or vector), J; without stiffness none.
template <class Tangential>
inline double spring_energy(const Tangential& spring, double stiffness) {
  return stiffness > 0 ? 0.5 * square_of(spring) / stiffness : 0.0;
}

/// What a contact with a Cundall-Strack spring remembers.
template <int D>
struct SpringMemory {
  TangentialOf<D> spring = zero<TangentialOf<D>>();  ///< its force on i, N

  bool empty() const { return spring == zero<TangentialOf<D>>(); }
  /// Seen from j. In 2D the tangent turns round with the normal, and the number stays.
  SpringMemory reversed() const {
    if constexpr (D == 2) return *this;
    return {-spring};
  }
};

/// A contact counts as sliding when its tangential force is within this share of the Coulomb limit.
inline constexpr double kSlidingMargin = 1e-6;

/// The part of a tangential force that is within a limit.
inline double capped(double value, double limit) {
  return std::min(std::max(value, -limit), limit);
}
template <class Derived>
typename Derived::PlainObject capped(const Eigen::MatrixBase<Derived>& value, double limit) {
  const double square = value.squaredNorm();
  if (!(square > limit * limit)) return value;
  return (limit / std::sqrt(square)) * value;
}

/// Cundall-Strack friction. The spring (the contact's memory, in N, as a force on i) advances by
/// -stiffness * slip * dt; the dashpot acts beside it and never accumulates in it; the sum is
/// capped at mu * normal, and then the spring is what the cap leaves for it, itself within the cap.
/// Returns the tangential force on i. In 2D numbers, in 3D vectors across the normal.
template <class Tangential>
inline Tangential friction_force(double normal, double mu, double stiffness, double viscosity,
                                 const Tangential& slip, double dt, Tangential& spring) {
  const double limit = mu * normal;
  const Tangential viscous = -viscosity * slip;
  const Tangential trial = spring - stiffness * slip * dt;
  const Tangential sum = trial + viscous;
  const Tangential force = capped(sum, limit);
  const Tangential rest = force == sum ? trial : Tangential(force - viscous);
  spring = capped(rest, limit);
  return force;
}

}  // namespace grainfield::dem
