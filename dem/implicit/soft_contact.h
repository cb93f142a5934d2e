// Force of one contact of soft disks over a step of time (Liffman et al. 1992, eqs 23-36).
//
// s is the overlap, negative apart; 0 and 1 mark the start and the end of the step. c is the way
// that the two came nearer along n in it, q the way that i slipped over j along t = (-n_y, n_x):
//
//   V = K s^2/2 where s > 0
//   f = (V_1 - V_0)/(s_1 - s_0) = K (s_0 + s_1)/2 where both are overlaps                     (24)
//   N = max(f + share K_D c/dt, 0)                                                           (25)
//   viscous   T = -clamp(share K_slip q/dt, mu_roll N)                                 (27-29, 32)
//   coulomb   S_1 = clamp(S_0 - share k_t q, mu N)
//             T = clamp((S_0 + S_1)/2 - share K_slip q/dt, mu N)
//   well      W = -clamp(mu_static N (x_0 + x_1 - 2 x_rest)/(2 a), mu_static N)             (30,
//   33)
//
// With n = (d_0 + d_1)/(r_0 + r_1) of the way d from i to j, of length r (Greenspan 1984), f n does
// the work V_0 - V_1 exactly. Where only one of s_0, s_1 is an overlap the quotient holds, and
// `share`, the part of the step in which they touch when s runs linearly, lets dashpots begin and
// end without a jump. As printed (25) pulls on grains that part quickly; here N does not.
//
// (29) as printed lacks the sign of the slip, (30) takes half the difference of the two places, and
// (36) lacks a sign: T turns both disks, W none.
//
// BDF2 (soft_disks.h) takes forces at the end of the step instead, with rates c', q' there:
//
//   f = K s_1      N = max(f + K_D c', 0)
//   viscous   T = -clamp(K_slip q', mu_roll N)
//   coulomb   S_1 as above, T = clamp(S_1 - K_slip q', mu N)
//   well      W = -clamp(mu_static N (x_1 - x_rest)/a, mu_static N)
//
// The text is one for numbers and for numbers with their derivatives (Eigen's AutoDiffScalar): the
// tangent is the exact derivative, with its branches.
#pragma once
#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

namespace grainfield::dem {

enum class SoftFriction { viscous, coulomb };

/// Law of a pair of disks, or of a disk and a wall.
struct SoftLaw {
  double stiffness = 1e7;  ///< K, N/m
  double damping = 0;      ///< K_D, kg/s
  SoftFriction friction = SoftFriction::viscous;
  double slip_damping = 0;          ///< K_slip, kg/s
  double rolling_friction = 0;      ///< mu_roll: limit of viscous friction over N
  double coulomb = 0;               ///< mu of coulomb
  double tangential_stiffness = 0;  ///< k_t of coulomb, N/m
  double static_friction = 0;       ///< mu_static of a wall's well; 0: none
  double well = 0;                  ///< a, half width of the well, m
  bool renewed = false;  ///< wells form where a disk comes to touch the wall, too, and anew where
                         ///< it leaves one: what moves along the wall is dragged

  bool has_tangential() const {
    return friction == SoftFriction::viscous ? rolling_friction > 0 && slip_damping > 0
                                             : coulomb > 0;
  }
};

/// What a contact remembers from step to step.
struct SoftMemory {
  double spring = 0;   ///< S, on i along t, N
  double rest = 0;     ///< x_rest of a wall's well, along the wall, m
  bool whole = false;  ///< the well holds
};

namespace soft_contact {

/// With its derivatives by the motion of i against j (two numbers, m) and the turn that slips
/// (rad): SoftMotion in this order.
using Derived3 = Eigen::AutoDiffScalar<Eigen::Vector3d>;

inline double value_of(double x) { return x; }
inline double value_of(const Derived3& x) { return x.value(); }

template <class T>
T clamped(const T& x, const T& limit) {
  if (value_of(x) > value_of(limit)) return limit;
  if (value_of(x) < -value_of(limit)) return T(-limit);
  return x;
}

}  // namespace soft_contact

/// Motion of i relative to j over the step; they share the turn: (r_i a_i + r_j a_j)/(r_i + r_j).
template <class T>
struct SoftMotion {
  Eigen::Matrix<T, 2, 1> shift;  ///< u_i - u_j, m
  T turn;                        ///< rad
};

/// How forces are taken over a step.
struct SoftStep {
  double dt = 0;                ///< s
  bool end = false;             ///< at its end, with velocities (shift - drift) rate, as BDF2 does
  double rate = 0;              ///< 1/s
  Eigen::Vector2d drift{0, 0};  ///< of SoftMotion::shift, m
  double turn_drift = 0;        ///< of SoftMotion::turn, rad
};

template <class T>
struct SoftForce {
  using V = Eigen::Matrix<T, 2, 1>;
  V force;                 ///< on i, with the well's, N
  T moment;                ///< T times the distance of the centres; each has its radius' share, N m
  double overlap_end = 0;  ///< s_1, m
  double elastic = 0, normal = 0, tangential = 0, well = 0;  ///< f, N, T, W, N
  double closing = 0, slip = 0, along = 0;                   ///< c, q, way along the wall, m
  double spring = 0;                                         ///< S_1, N
};

namespace soft_contact {

/// Where two meet: the normal, not of unit length in the middle of the step, and the distance of
/// the centres along it.
template <class T>
struct Place {
  Eigen::Matrix<T, 2, 1> n;
  T lever;
};

template <class T>
T along_of(const Place<T>& at, const Eigen::Matrix<T, 2, 1>& shift) {
  return T(at.n.x() * shift.y() - at.n.y() * shift.x());
}

template <class T>
void put(const Place<T>& at, const T& elastic, const T& normal, const T& tangential, const T& well,
         SoftForce<T>& out) {
  const T across = T(tangential + well);
  out.force.x() = T(-(normal * at.n.x()) - across * at.n.y());
  out.force.y() = T(-(normal * at.n.y()) + across * at.n.x());
  out.moment = T(at.lever * tangential);
  out.elastic = value_of(elastic);
  out.normal = value_of(normal);
  out.tangential = value_of(tangential);
  out.well = value_of(well);
}

/// Forces at the end of the step, where the normal is that of `last`; ways along `middle`. False:
/// they do not touch then.
template <class T>
bool act_at_end(const SoftLaw& law, const SoftStep& step, const T& s1, const Place<T>& middle,
                const Place<T>& last, const SoftMemory& memory, double place,
                const SoftMotion<T>& m, SoftForce<T>& out) {
  const double end = value_of(s1);
  if (!(end > 0)) return false;
  Eigen::Matrix<T, 2, 1> velocity;
  velocity.x() = T((m.shift.x() - step.drift.x()) * step.rate);
  velocity.y() = T((m.shift.y() - step.drift.y()) * step.rate);
  const T closing = T(last.n.x() * velocity.x() + last.n.y() * velocity.y());
  const T slip =
      T(along_of(last, velocity) + last.lever * ((m.turn - step.turn_drift) * step.rate));
  const T along = along_of(middle, m.shift), way = T(along + middle.lever * m.turn);
  const T elastic = T(law.stiffness * s1);
  T normal = T(elastic + law.damping * closing);
  if (!(value_of(normal) > 0)) normal = T(0);
  T tangential(0), well(0);
  double spring = 0;
  if (law.has_tangential()) {
    const T viscous = T(law.slip_damping * slip);
    if (law.friction == SoftFriction::viscous) {
      tangential = T(-clamped(viscous, T(law.rolling_friction * normal)));
    } else {
      const T limit = T(law.coulomb * normal);
      const T after = clamped(T(memory.spring - law.tangential_stiffness * way), limit);
      tangential = clamped(T(after - viscous), limit);
      spring = value_of(after);
    }
  }
  if (memory.whole && law.static_friction > 0) {
    const T hold = T((law.static_friction / law.well) * normal);
    well = T(-clamped(T(hold * (along + (place - memory.rest))), T(law.static_friction * normal)));
  }
  put(last, elastic, normal, tangential, well, out);
  out.overlap_end = end;
  out.closing = value_of(T(middle.n.x() * m.shift.x() + middle.n.y() * m.shift.y()));
  out.slip = value_of(way);
  out.along = value_of(along);
  out.spring = spring;
  return true;
}

/// Forces by overlaps s_0, s_1 where the two meet in mid-step. False: they do not touch.
template <class T>
bool act(const SoftLaw& law, double dt, double s0, const T& s1, const Place<T>& at,
         const SoftMemory& memory, double place, const SoftMotion<T>& m, SoftForce<T>& out) {
  const Eigen::Matrix<T, 2, 1>& n = at.n;
  const double end = value_of(s1);
  if (!(s0 > 0) && !(end > 0)) return false;
  T elastic, share(1);
  if (s0 > 0 && end > 0) {
    elastic = T(0.5 * law.stiffness * (s1 + s0));
  } else if (end > 0) {
    share = T(s1 / (s1 - s0));
    elastic = T(0.5 * law.stiffness * (share * s1));
  } else {
    share = T(s0 / (s0 - s1));
    elastic = T(0.5 * law.stiffness * s0 * share);
  }
  const T closing = n.x() * m.shift.x() + n.y() * m.shift.y();
  const T slip = n.x() * m.shift.y() - n.y() * m.shift.x() + at.lever * m.turn;
  T normal = T(elastic + (law.damping / dt) * (share * closing));
  if (!(value_of(normal) > 0)) normal = T(0);

  T tangential(0), well(0);
  double spring = 0;
  if (law.has_tangential()) {
    const T viscous = T((law.slip_damping / dt) * (share * slip));
    if (law.friction == SoftFriction::viscous) {
      tangential = T(-clamped(viscous, T(law.rolling_friction * normal)));
    } else {
      const T limit = T(law.coulomb * normal);
      const T after = clamped(T(memory.spring - law.tangential_stiffness * (share * slip)), limit);
      tangential = clamped(T(0.5 * (after + memory.spring) - viscous), limit);
      if (end > 0) spring = value_of(after);
    }
  }
  const T along = along_of(at, m.shift);
  if (memory.whole && law.static_friction > 0) {
    const T hold = T((law.static_friction / law.well) * normal);
    well = T(
        -clamped(T(hold * (0.5 * along + (place - memory.rest))), T(law.static_friction * normal)));
  }
  put(at, elastic, normal, tangential, well, out);
  out.overlap_end = end;
  out.closing = value_of(closing);
  out.slip = value_of(slip);
  out.along = value_of(along);
  out.spring = spring;
  return true;
}

}  // namespace soft_contact

/// Disks whose centres are `way` apart (from i to j) at the start of the step, `reach` the sum of
/// their radii. False: they touch at neither end of the step.
template <class T>
bool soft_pair(const SoftLaw& law, const SoftStep& step, const Eigen::Vector2d& way, double reach,
               const SoftMemory& memory, const SoftMotion<T>& m, SoftForce<T>& out) {
  using std::sqrt;
  const T x = T(way.x() - m.shift.x()), y = T(way.y() - m.shift.y());
  const T square = T(x * x + y * y);
  const double start = way.norm();
  if (!(soft_contact::value_of(square) > 0) ||
      (start >= reach && soft_contact::value_of(square) >= reach * reach)) {
    return false;
  }
  const T distance = T(sqrt(square)), both = T(distance + start);
  soft_contact::Place<T> middle;
  middle.n.x() = T((x + way.x()) / both);
  middle.n.y() = T((y + way.y()) / both);
  middle.lever = T(0.5 * (middle.n.x() * (x + way.x()) + middle.n.y() * (y + way.y())));
  const T s1 = T(reach - distance);
  if (!step.end) {
    return soft_contact::act(law, step.dt, reach - start, s1, middle, memory, 0.0, m, out);
  }
  soft_contact::Place<T> last;
  last.n.x() = T(x / distance);
  last.n.y() = T(y / distance);
  last.lever = distance;
  return soft_contact::act_at_end(law, step, s1, middle, last, memory, 0.0, m, out);
}

/// A disk whose centre is `height` above a wall and `place` along t = (-n_y, n_x), n from the disk
/// into the wall, at the start of the step. False likewise.
template <class T>
bool soft_wall(const SoftLaw& law, const SoftStep& step, const Eigen::Vector2d& into, double height,
               double place, double radius, const SoftMemory& memory, const SoftMotion<T>& m,
               SoftForce<T>& out) {
  soft_contact::Place<T> middle;
  middle.n.x() = T(into.x());
  middle.n.y() = T(into.y());
  const T closing = T(into.x() * m.shift.x() + into.y() * m.shift.y());
  const T s1 = T(closing + (radius - height));
  middle.lever = T(height - 0.5 * closing);
  if (!step.end) {
    return soft_contact::act(law, step.dt, radius - height, s1, middle, memory, place, m, out);
  }
  soft_contact::Place<T> last = middle;
  last.lever = T(height - closing);
  return soft_contact::act_at_end(law, step, s1, middle, last, memory, place, m, out);
}

}  // namespace grainfield::dem
