// The impulse between two round bodies that collide (Liffman et al. 1992, eqs 4-21).
//
// n points from the first body to the second; they touch at r_1 n from the centre of the one and
// -r_2 n from that of the other. There the first moves relative to the second at
//
//   g = c_1 - c_2 + (r_1 w_1 + r_2 w_2) x n                                               (9)
//
// P acts on the first body, -P on the second, both at the point of contact:
//
//   P_n = -m (1 + e) g_n,           1/m = 1/m_1 + 1/m_2                                  (12)
//   P_t = -m_t g_t without slip,    1/m_t = 1/m + r_1^2/I_1 + r_2^2/I_2                  (16)
//   P_t of the size mu |P_n| along the same, where that is less: slip                    (19)
//   c_1 += P/m_1,  c_2 -= P/m_2,  w_1 += r_1 n x P/I_1,  w_2 += r_2 n x P/I_2        (6, 13, 14)
//
// (19) as printed compares with signs, which holds for one direction of slip; (14) as printed turns
// the second body the wrong way. Energy lost, by (9), (12) and (16):
//
//   m (1 - e^2) g_n^2/2  +  m_t g_t^2/2 without slip, mu |P_n| (|g_t| - mu |P_n|/(2 m_t)) with it
//
// Both are the same where slip begins, m_t |g_t| = mu |P_n|. A body of infinite mass (a wall) has
// inverse mass and inertia 0.
#pragma once
#include <cmath>

#include "dem/space/kinematics3.h"

namespace grainfield::dem {

struct ImpactLaw {
  double restitution = 1;  ///< e in [0, 1]: speed of parting over that of approach
  double friction = 0;     ///< mu >= 0; 0: smooth
};

/// What a collision did.
template <int D>
struct Impact {
  double normal = 0;                                     ///< size of the repulsion, N s
  TangentialOf<D> tangential = zero<TangentialOf<D>>();  ///< on the first body, N s
  bool slips = false;                                    ///< friction at its limit
  double lost = 0;                                       ///< kinetic energy lost, J
};

/// Moment of inertia of a disk or a sphere of this mass about its centre.
template <int D>
constexpr double round_inertia(double mass, double radius) {
  return (D == 2 ? 0.5 : 0.4) * mass * radius * radius;
}

namespace detail {

inline Overlap touch_of(const Body<2>& a, const Body<2>& b, const VectorOf<2>& n) {
  Overlap o;
  o.nx = n.x();
  o.ny = n.y();
  o.arm_i = a.radius;
  o.arm_j = b.radius;
  return o;
}
inline Overlap3 touch_of(const Body<3>& a, const Body<3>& b, const VectorOf<3>& n) {
  Overlap3 o;
  o.normal = n;
  o.arm_i = a.radius * n;
  o.arm_j = -b.radius * n;
  return o;
}

}  // namespace detail

/// The impulse between bodies that move so where they touch, at `arm_i` and `arm_j` (m) from their
/// centres. Of bodies that part: none.
template <int D>
Impact<D> impact_of(const ContactMotion<D>& m, double arm_i, double arm_j, const ImpactLaw& law) {
  Impact<D> out;
  if (!(m.approach > 0)) return out;
  const double inverse = m.inverse_mass;
  out.normal = (1 + law.restitution) * m.approach / inverse;
  out.lost = 0.5 * (1 - law.restitution * law.restitution) * m.approach * m.approach / inverse;
  if (law.friction == 0) return out;
  const double inverse_t =
      inverse + arm_i * arm_i * m.inverse_inertia_i + arm_j * arm_j * m.inverse_inertia_j;
  const double slip = size_of(m.slip), most = law.friction * out.normal;
  out.slips = slip > most * inverse_t;
  if (out.slips) {
    out.tangential = (-most / slip) * m.slip;
    out.lost += most * (slip - 0.5 * most * inverse_t);
  } else {
    out.tangential = (-1 / inverse_t) * m.slip;
    out.lost += 0.5 * slip * slip / inverse_t;
  }
  return out;
}

/// Two bodies collide along the unit vector `normal` from the first to the second: their velocities
/// and spins become those after it. Bodies that part, or both of infinite mass, stay as they are.
template <int D>
Impact<D> collide(Body<D>& a, Body<D>& b, const VectorOf<D>& normal, const ImpactLaw& law) {
  if (a.inverse_mass + b.inverse_mass == 0) return {};
  const auto touch = detail::touch_of(a, b, normal);
  const Impact<D> out = impact_of<D>(motion_at<true>(a, b, touch), a.radius, b.radius, law);
  const ContactForce<D> f = forces_at<true>(touch, out.normal, out.tangential);
  a.velocity += a.inverse_mass * f.force;
  b.velocity -= b.inverse_mass * f.force;
  a.spin += a.inverse_inertia * f.torque_i;
  b.spin += b.inverse_inertia * f.torque_j;
  return out;
}

struct Push {
  double impulse = 0;  ///< N s
  double gain = 0;     ///< kinetic energy that it took, J
};

/// Bodies that part along the unit vector from the first to the second more slowly than `least`
/// (m/s) part so fast; where that is not above 0 nothing is done.
template <int D>
Push push_apart(Body<D>& a, Body<D>& b, const VectorOf<D>& normal, double least) {
  const double parting = (b.velocity - a.velocity).dot(normal);
  if (!(least > 0 && parting < least)) return {};
  const double mass = 1 / (a.inverse_mass + b.inverse_mass), impulse = mass * (least - parting);
  a.velocity -= impulse * a.inverse_mass * normal;
  b.velocity += impulse * b.inverse_mass * normal;
  return {impulse, 0.5 * mass * (least * least - parting * parting)};
}

}  // namespace grainfield::dem
