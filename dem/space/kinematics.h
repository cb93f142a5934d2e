// Velocities at a contact point and what a force there does: v + omega x r and r x F, once, of one
// contact and of several side by side (number.h).
//
// In two dimensions all is said in the frame of the contact, with the normal n, the tangent
// t = (-n_y, n_x) and the arms r_i = lever_i n + shift_i t, r_j = -lever_j n + shift_j t:
//   (omega x r_i) . n = -omega shift_i     (omega x r_i) . t = omega lever_i     and so on.
#pragma once
#include "dem/space/body.h"
#include "dem/space/overlap.h"
#include "dem/space/space.h"

namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS {

/// Motion and inertia at a contact.
template <int D, class N = double>
struct ContactMotion {
  N approach = zero<N>();  ///< closing speed along the normal, m/s
  /// Velocity of i relative to j across it, m/s.
  TangentialOf<D, N> slip = zero<TangentialOf<D, N>>();
  N inverse_mass = zero<N>();  ///< sum of both, 1/kg
  N inverse_inertia_i = zero<N>(), inverse_inertia_j = zero<N>();
};

template <int D, class N>
[[gnu::always_inline]] inline void set_inertia(const Body<D, N>& a, const Body<D, N>& b,
                                               ContactMotion<D, N>& m) {
  m.inverse_mass = a.inverse_mass + b.inverse_mass;
  m.inverse_inertia_i = a.inverse_inertia;
  m.inverse_inertia_j = b.inverse_inertia;
}

/// `central`: the contact point lies on the line of centres, so levers are arms and shifts 0.
template <bool central, class N>
[[gnu::always_inline]] inline ContactMotion<2, N> motion_at(const Body<2, N>& a,
                                                            const Body<2, N>& b,
                                                            const Overlap2Of<N>& o) {
  const N vx = a.velocity.x() - b.velocity.x(), vy = a.velocity.y() - b.velocity.y();
  ContactMotion<2, N> m;
  m.approach = vx * o.nx + vy * o.ny;
  if constexpr (central) {
    m.slip = vy * o.nx - vx * o.ny + a.spin * o.arm_i + b.spin * o.arm_j;
  } else {
    m.approach += b.spin * o.shift_j - a.spin * o.shift_i;
    m.slip = vy * o.nx - vx * o.ny + a.spin * o.lever_i + b.spin * o.lever_j;
  }
  set_inertia(a, b, m);
  return m;
}

/// Of a repulsion `normal` and a force `tangential` on the first body along t, N.
template <bool central, class N>
[[gnu::always_inline]] inline ContactForce<2, N> forces_at(
    const Overlap2Of<N>& o, const std::type_identity_t<N>& normal,
    const std::type_identity_t<N>& tangential) {
  ContactForce<2, N> f;
  f.force.x() = -normal * o.nx - tangential * o.ny;
  f.force.y() = -normal * o.ny + tangential * o.nx;
  if constexpr (central) {
    f.torque_i = o.arm_i * tangential;
    f.torque_j = o.arm_j * tangential;
  } else {
    f.torque_i = o.lever_i * tangential + o.shift_i * normal;
    f.torque_j = o.lever_j * tangential - o.shift_j * normal;
  }
  return f;
}

/// The contact point, m.
template <bool central>
inline VectorOf<2> point_at(const Body<2>& a, const Overlap& o) {
  const double x = a.position.x(), y = a.position.y();
  if constexpr (central) return {x + o.arm_i * o.nx, y + o.arm_i * o.ny};
  return {x + o.lever_i * o.nx - o.shift_i * o.ny, y + o.lever_i * o.ny + o.shift_i * o.nx};
}

inline VectorOf<2> normal_of(const Overlap& o) { return {o.nx, o.ny}; }

/// Parts of a force on the first body: repulsion, and along t.
inline double repulsion_of(const VectorOf<2>& force, const Overlap& o) {
  return -(force.x() * o.nx + force.y() * o.ny);
}
inline double tangential_of(const VectorOf<2>& force, const Overlap& o) {
  return force.y() * o.nx - force.x() * o.ny;
}

}  // namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS
