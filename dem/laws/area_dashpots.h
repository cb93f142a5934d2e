// What Roul's law (overlap_area.h) and the laws of an energy of the overlap area (energy.h) share:
// his dashpots, his spring of friction, and what of them bounds the time step.
//
//   D = gamma (dA/dt)/l sqrt(E m_eff)    m_eff = m_i m_j / (m_i + m_j),  D >= -R: never attractive
//   spring k_t v_t dt, k_t = (2/7) E or another share, dashpot sqrt(k_t m_t) v_t, 1/m_t = 1/m_i +
//   1/m_j + r_i^2/I_i + r_j^2/I_j
#pragma once
#include "dem/laws/contact.h"

namespace grainfield::dem {

struct AreaDashpots {
  double young = 1e7;                 ///< E, N/m
  double damping = 0.75;              ///< gamma, -; raising it makes impacts less elastic
  double tangential_ratio = 2.0 / 7;  ///< k_t/E, -

  /// Stiffness that bounds the time step, N/m: of disks up to an overlap of 5 % of R.
  double stiffness(double /*radius*/ = 0) const { return std::max(1.0, tangential_ratio) * young; }
  double tangential_stiffness(double /*radius*/ = 0) const { return young * tangential_ratio; }

  /// Decay rate of the fastest dashpot mode of a packing of equal disks of mass m, 1/s: six
  /// neighbours spinning alike, 24 c/m with c = sqrt((2/7) E m/6), or moving against each other,
  /// 6 c/m with c = gamma (chord/l) sqrt(E m/2) and a chord of 0.6 l (an overlap of 2 % of r).
  double viscous_rate(double mass, double /*radius*/ = 0) const {
    return std::max(24 * std::sqrt(tangential_stiffness() / (6 * mass)),
                    6 * 0.6 * damping * std::sqrt(young / (2 * mass)));
  }
  /// Decay rate, 1/s, that the fastest mode of a chain of grains feels which lie edge on edge, with
  /// chord / l up to `chord`.
  double edge_rate(double mass, double chord) const {
    return 4 * damping * chord * std::sqrt(young / (2 * mass));
  }

  /// `repulsion`: R, N.
  LawForce<2> forces(double repulsion, const Overlap& o, const ContactMotion<2>& m, double mu,
                     double dt, SpringMemory<2>& memory) const {
    const double inverse_sum = m.inverse_mass;
    const double viscous =
        damping * o.chord * m.approach / o.length * std::sqrt(young / inverse_sum);
    const double normal = std::max(repulsion + viscous, 0.0);
    const double inverse_tangential = inverse_sum + o.arm_i * o.arm_i * m.inverse_inertia_i +
                                      o.arm_j * o.arm_j * m.inverse_inertia_j;
    const double kt = tangential_stiffness();
    const double force = friction_force(normal, mu, kt, std::sqrt(kt / inverse_tangential), m.slip,
                                        dt, memory.spring);
    return {normal, force};
  }
};

}  // namespace grainfield::dem
