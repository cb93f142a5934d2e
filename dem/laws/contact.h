// What every contact law takes and gives, and the friction that all share.
#pragma once
#include <algorithm>
#include <cmath>

#include "dem/space/kinematics.h"
#include "dem/space/overlap.h"

namespace grainfield::dem {

/// Forces of a contact: `normal` >= 0 repels; `tangential` acts on i (in 2D along (-n_y, n_x)).
template <int D, class N = double>
struct LawForce {
  N normal = zero<N>();
  TangentialOf<D, N> tangential = zero<TangentialOf<D, N>>();
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
template <int D, class N = double>
struct SpringMemory {
  TangentialOf<D, N> spring = zero<TangentialOf<D, N>>();  ///< its force on i, N

  bool empty() const { return spring == zero<TangentialOf<D, N>>(); }
  /// Seen from j. In 2D the tangent turns round with the normal, and the number stays.
  SpringMemory reversed() const {
    if constexpr (D == 2) return *this;
    return {-spring};
  }
};

/// A contact counts as sliding when its tangential force is within this share of the Coulomb limit.
inline constexpr double kSlidingMargin = 1e-6;

inline namespace GRAINFIELD_INSTRUCTIONS {

/// What is not below 0.
template <class N>
[[gnu::always_inline]] inline N at_least_zero(const N& x) {
  return x < 0 ? zero<N>() : x;
}
/// The part of a tangential force that is within a limit. Seldom does any of the lanes slide.
template <class Tangential, class N>
[[gnu::always_inline]] inline Tangential capped(const Tangential& value, const N& limit) {
  if constexpr (std::is_same_v<Tangential, N>) {
    const N above = value < -limit ? N(-limit) : value;
    return limit < above ? limit : above;
  } else {
    const N square = value.squaredNorm();
    const auto slides = square > limit * limit;
    if (!any(slides)) return value;
    return chosen(slides, Tangential((limit / root(square)) * value), value);
  }
}

/// Cundall-Strack friction. The spring (the contact's memory, in N, as a force on i) advances by
/// -stiffness * slip * dt; the dashpot acts beside it and never accumulates in it; the sum is
/// capped at mu * normal, and then the spring is what the cap leaves for it, itself within the cap.
/// Returns the tangential force on i. In 2D numbers, in 3D vectors across the normal. Stiffness and
/// viscosity: doubles, or numbers as `normal`.
template <class Tangential, class N, class Stiffness, class Viscosity>
[[gnu::always_inline]] inline Tangential friction_force(
    const N& normal, const std::type_identity_t<N>& mu, const Stiffness& stiffness,
    const Viscosity& viscosity, const Tangential& slip, double dt, Tangential& spring) {
  const N limit = mu * normal;
  const Tangential viscous = -viscosity * slip;
  const Tangential trial = spring - stiffness * slip * dt;
  const Tangential sum = trial + viscous;
  const Tangential force = capped(sum, limit);
  const Tangential rest = chosen(same(force, sum), trial, Tangential(force - viscous));
  spring = capped(rest, limit);
  return force;
}

}  // namespace GRAINFIELD_INSTRUCTIONS

}  // namespace grainfield::dem
