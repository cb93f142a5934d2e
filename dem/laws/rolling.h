// Resistance against rolling and twisting of round bodies: a spring, a dashpot and a cap each
// (Luding 2008; Marshall 2009; physics section 5; LAMMPS' granular with rolling sds, twisting sds).
//
//   rolling    v_r = R_eff (w_i - w_j) x n     spring f -= k_r v_r dt, kept across n
//              pseudo-force f - g_r v_r, capped at mu_r F_n; moments +-R_eff n x that force
//   twisting   W = (w_i - w_j) . n             spring m -= k_tw W dt
//              moment m - g_tw W along n, capped at mu_tw F_n
//
// R_eff = R_i R_j/(R_i + R_j), at a wall R_i; F_n the whole normal force. The spring is shortened
// to what the cap leaves it. The pseudo-force moves nothing: only its moments act. In the plane
// there is no twisting, and v_r = R_eff (w_i - w_j) along the tangent.
#pragma once
#include "dem/laws/contact.h"
#include "dem/laws/material_setup.h"
#include "dem/space/body.h"
#include "dem/space/kinematics3.h"

namespace grainfield::dem {

/// What a contact remembers of rolling and twisting.
template <int D, class N = double>
struct RollingMemory {
  TangentialOf<D, N> roll = zero<TangentialOf<D, N>>();  ///< pseudo-force of the spring on i, N
  N twist = zero<N>();                                   ///< moment of the spring on i along n, N m

  bool empty() const { return twist == 0 && roll == zero<TangentialOf<D, N>>(); }
  /// Seen from j: n and w_i - w_j both turn round, so vectors stay; in 2D so does the tangent.
  RollingMemory reversed() const {
    if constexpr (D == 2) return {-roll, twist};
    return *this;
  }
};

/// How two bodies roll and twist on each other.
template <int D, class N = double>
struct Turning {
  SpinOf<D, N> between = zero<SpinOf<D, N>>();  ///< w_i - w_j, rad/s
  N radius = zero<N>();                         ///< R_eff, m
  N twist = zero<N>();  ///< of both in a step about the normal (twist_of), rad; 3D
};
template <int D, class N>
[[gnu::always_inline]] inline Turning<D, N> turning_of(const Body<D, N>& a, const Body<D, N>& b,
                                                       const OverlapIn<D, N>& o, double dt) {
  Turning<D, N> t;
  t.between = a.spin - b.spin;
  t.radius = b.radius > 0 ? N(a.radius * b.radius / (a.radius + b.radius)) : a.radius;
  if constexpr (D == 3) t.twist = twist_of(a, b, o, dt);
  return t;
}

/// Of two materials. Off while both coefficients of friction are 0.
struct RollingLaw {
  double stiffness = 0;           ///< k_r, N/m
  double damping = 0;             ///< g_r, kg/s
  double friction = 0;            ///< mu_r, -: a disk rests on slopes up to tan(theta) = mu_r
  double twisting_stiffness = 0;  ///< k_tw, N m; 3D
  double twisting_damping = 0;    ///< g_tw, N m s; 3D
  double twisting_friction = 0;   ///< mu_tw, m; 3D

  static RollingLaw of(const MaterialSetup& m) {
    return {m.rolling_stiffness,  m.rolling_damping,  m.rolling_friction,
            m.twisting_stiffness, m.twisting_damping, m.twisting_friction};
  }

  bool twists() const { return twisting_friction > 0; }
  bool on() const { return friction > 0 || twists(); }

  /// What bounds the time step, of mass (kg) and radius (m; of twisting): stiffness, N/m, and decay
  /// rate, 1/s. Twelve larger neighbours at rest: each moment of rolling, 2/3 of them across a
  /// spin, answers R k_r R, each of twisting, 1/3 of them, k_tw; over 0.4 m R^2 that is 20 k_r/m
  /// and 10 k_tw/(m R^2); disks, with six over m R^2/2, 12 k_r/m. stable_time_step takes up to 40
  /// stiffnesses over m.
  double step_stiffness(double radius) const {
    if (!on()) return 0;
    return (friction > 0 ? stiffness : 0) + (twists() ? twisting_stiffness / (radius * radius) : 0);
  }
  double step_rate(double mass, double radius) const {
    if (!on()) return 0;
    return ((friction > 0 ? 20 * damping : 0) +
            (twists() ? 10 * twisting_damping / (radius * radius) : 0)) /
           mass;
  }

  /// The moment on i, N m; that on j is its opposite. `repulsion`: F_n, N. The memory advances by
  /// dt, s, as the spring of friction does (contact.h).
  template <int D, class N>
  [[gnu::always_inline]] SpinOf<D, N> moment(const Turning<D, N>& t, const OverlapIn<D, N>& o,
                                             const N& repulsion, double dt,
                                             RollingMemory<D, N>& memory) const {
    if constexpr (D == 2) {
      return t.radius * held(repulsion, N(t.radius * t.between), dt, memory.roll);
    } else {
      using V = VectorOf<3, N>;
      turn_with_contact(memory.roll, o.normal, t.twist, o);
      const V rolling = t.radius * t.between.cross(o.normal);
      const V force = held(repulsion, rolling, dt, memory.roll);
      const N twist = capped_spring(repulsion, twisting_friction, twisting_stiffness,
                                    twisting_damping, N(t.between.dot(o.normal)), dt, memory.twist);
      return t.radius * o.normal.cross(force) + twist * o.normal;
    }
  }
  template <int D>
  SpinOf<D> moment(const Body<D>& a, const Body<D>& b, const OverlapIn<D>& o, double repulsion,
                   double dt, RollingMemory<D>& memory) const {
    return moment(turning_of(a, b, o, dt), o, repulsion, dt, memory);
  }

  /// Stored in the springs, J.
  template <int D>
  double energy(const RollingMemory<D>& memory) const {
    return (stiffness > 0 ? 0.5 * square_of(memory.roll) / stiffness : 0.0) +
           (twisting_stiffness > 0 ? 0.5 * memory.twist * memory.twist / twisting_stiffness : 0.0);
  }

 private:
  template <class N, class T>
  [[gnu::always_inline]] T held(const N& repulsion, const T& velocity, double dt, T& spring) const {
    return capped_spring(repulsion, friction, stiffness, damping, velocity, dt, spring);
  }
  /// As friction_force; without a stiffness there is no spring, also beyond the cap.
  template <class N, class T>
  [[gnu::always_inline]] static T capped_spring(const N& repulsion, double mu, double stiffness,
                                                double damping, const T& velocity, double dt,
                                                T& spring) {
    const T force =
        friction_force(repulsion, N(zero<N>() + mu), stiffness, damping, velocity, dt, spring);
    if (!(stiffness > 0)) spring = zero<T>();
    return force;
  }
};

}  // namespace grainfield::dem
