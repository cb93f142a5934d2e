// Linear spring and dashpot on the overlap depth, damping proportional to the effective mass.
//
//   F_n = k_n depth + m_eff gamma_n v_n   (never attractive)
//   spring k_t v_t dt, dashpot m_eff gamma_t v_t
#pragma once
#include "dem/laws/contact.h"
#include "dem/laws/edge_measure.h"
#include "dem/laws/material_setup.h"

namespace grainfield::dem {

struct LinearLaw {
  static constexpr const char* name = "linear";
  static constexpr Measures measures = Measures::depth;
  static constexpr EdgeMeasure edges = EdgeMeasure::none;
  template <int D, class N = double>
  using Memory = SpringMemory<D, N>;
  double normal_stiffness = 1e7;           ///< k_n, N/m
  double tangential_stiffness_ = 2e7 / 7;  ///< k_t, N/m
  double normal_damping = 500;             ///< gamma_n, 1/s
  double tangential_damping = 250;         ///< gamma_t, 1/s

  static LinearLaw of(const MaterialSetup& m) {
    return {m.normal_stiffness, m.tangential_stiffness, m.normal_damping, m.tangential_damping};
  }

  double stiffness(double /*radius*/ = 0) const {
    return std::max(normal_stiffness, tangential_stiffness_);
  }
  double tangential_stiffness(double /*radius*/ = 0) const { return tangential_stiffness_; }

  /// Decay rate of the fastest dashpot mode of a packing of equal disks, 1/s: six neighbours
  /// spinning alike (24 c/m with c = gamma_t m/2), or moving against each other (6 c/m).
  double viscous_rate(double, double /*radius*/ = 0) const {
    return std::max(12 * tangential_damping, 3 * normal_damping);
  }

  /// Stiffness of a chain of grains edge on edge; the law does not use the edges' width.
  double edge_stiffness(double /*steepness*/) const { return 4 * normal_stiffness; }
  double edge_rate(double, double) const { return 2 * normal_damping; }

  static constexpr bool in_lanes = true;
  template <int D, class N>
  [[gnu::always_inline]] LawForce<D, N> operator()(const OverlapIn<D, N>& o,
                                                   const ContactMotion<D, N>& m,
                                                   const std::type_identity_t<N>& mu, double dt,
                                                   SpringMemory<D, N>& memory) const {
    const N mass = 1 / m.inverse_mass;
    const N normal = at_least_zero(N(repulsion(o) + mass * normal_damping * m.approach));
    const auto force = friction_force(normal, mu, tangential_stiffness_,
                                      N(mass * tangential_damping), m.slip, dt, memory.spring);
    return {normal, force};
  }

  double spring_stiffness(const auto& /*o*/) const { return tangential_stiffness_; }
  [[gnu::always_inline]] auto repulsion(const auto& o) const { return normal_stiffness * o.depth; }
  template <int D>
  ContactEnergy energy(const OverlapIn<D>& o, const SpringMemory<D>& memory) const {
    return {0.5 * normal_stiffness * o.depth * o.depth,
            spring_energy(memory.spring, tangential_stiffness_)};
  }
};

}  // namespace grainfield::dem
