// Roul's soft-grain law: repulsion from the overlap area (Roul ch. 2; physics: R = E A / l).
//
//   R = E A / l                          l = r_i r_j / (r_i + r_j)
//   D = gamma (dA/dt)/l sqrt(E m_eff)    m_eff = m_i m_j / (m_i + m_j),  D >= -R: never attractive
//   spring k_t v_t dt, k_t = (2/7) E or another share, dashpot sqrt(k_t m_t) v_t, 1/m_t = 1/m_i +
//   1/m_j + r_i^2/I_i + r_j^2/I_j
#pragma once
#include "dem/laws/contact.h"
#include "dem/laws/edge_measure.h"
#include "dem/laws/material_setup.h"

namespace grainfield::dem {

struct OverlapAreaLaw {
  static constexpr const char* name = "overlap_area";
  static constexpr Measures measures = Measures::area;
  static constexpr EdgeMeasure edges = EdgeMeasure::steepness;
  template <int D>
  using Memory = SpringMemory<D>;
  double young = 1e7;                 ///< E, N/m
  double damping = 0.75;              ///< gamma, -; raising it makes impacts less elastic
  double tangential_ratio = 2.0 / 7;  ///< k_t/E, -

  static OverlapAreaLaw of(const MaterialSetup& m) {
    return {m.young, m.damping, m.tangential_ratio};
  }

  /// Stiffness that bounds the time step, N/m.
  double stiffness(double /*radius*/ = 0) const { return std::max(1.0, tangential_ratio) * young; }
  double tangential_stiffness(double /*radius*/ = 0) const { return young * tangential_ratio; }

  /// Decay rate of the fastest dashpot mode of a packing of equal disks of mass m, 1/s: six
  /// neighbours spinning alike, 24 c/m with c = sqrt((2/7) E m/6), or moving against each other,
  /// 6 c/m with c = gamma (chord/l) sqrt(E m/2) and a chord of 0.6 l (an overlap of 2 % of r).
  double viscous_rate(double mass, double /*radius*/ = 0) const {
    return std::max(24 * std::sqrt(tangential_stiffness() / (6 * mass)),
                    6 * 0.6 * damping * std::sqrt(young / (2 * mass)));
  }

  /// Stiffness (N/m) and decay rate (1/s) that the fastest mode of a chain of grains feels which
  /// lie edge on edge, with chord / l up to `steepness`.
  double edge_stiffness(double steepness) const { return 4 * young * steepness; }
  double edge_rate(double mass, double steepness) const {
    return 4 * damping * steepness * std::sqrt(young / (2 * mass));
  }

  LawForce<2> operator()(const Overlap& o, const ContactMotion<2>& m, double mu, double dt,
                         SpringMemory<2>& memory) const {
    const double inverse_sum = m.inverse_mass_i + m.inverse_mass_j;
    const double viscous =
        damping * o.chord * m.approach / o.length * std::sqrt(young / inverse_sum);
    const double normal = std::max(repulsion(o) + viscous, 0.0);
    const double inverse_tangential = inverse_sum + o.arm_i * o.arm_i * m.inverse_inertia_i +
                                      o.arm_j * o.arm_j * m.inverse_inertia_j;
    const double kt = tangential_stiffness();
    const double force = friction_force(normal, mu, kt, std::sqrt(kt / inverse_tangential), m.slip,
                                        dt, memory.spring);
    return {normal, force};
  }

  double repulsion(const Overlap& o) const { return young / o.length * o.area; }
  /// Of the overlap the work of R at constant l, (E/l) * integral of A over the depth. The
  /// integral of the lens area is 2/5 A depth for small overlaps (A ~ depth^{3/2}), to O(depth/r).
  /// Of polygons it is a measure between a corner's 1/3 and the 1/2 of edge on edge.
  ContactEnergy energy(const Overlap& o, const SpringMemory<2>& memory) const {
    return {0.4 * young * o.area / o.length * o.depth,
            spring_energy(memory.spring, tangential_stiffness())};
  }
};

}  // namespace grainfield::dem
