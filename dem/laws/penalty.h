// Linear spring on the overlap depth with a dashpot by its own critical damping, and friction
// without one (Wellmann eqs. 5-8).
//
//   F_n = c_N d + D v_n, D = 2 zeta sqrt(c_N m_eff)   (never attractive)
//   spring c_T v_t dt, capped at mu F_n
#pragma once
#include "dem/laws/contact.h"
#include "dem/laws/edge_measure.h"
#include "dem/laws/material_setup.h"

namespace grainfield::dem {

struct PenaltyLaw {
  static constexpr const char* name = "penalty";
  static constexpr Measures measures = Measures::depth;
  static constexpr EdgeMeasure edges = EdgeMeasure::none;
  template <int D, class N = double>
  using Memory = SpringMemory<D, N>;
  double normal_stiffness = 1e7;       ///< c_N, N/m
  double tangential_stiffness_ = 1e7;  ///< c_T, N/m
  double damping = 1;                  ///< zeta, -; 1 is critical

  static PenaltyLaw of(const MaterialSetup& m) {
    return {m.normal_stiffness, m.tangential_stiffness, m.damping};
  }

  double stiffness(double /*radius*/ = 0) const {
    return std::max(normal_stiffness, tangential_stiffness_);
  }
  double tangential_stiffness(double /*radius*/ = 0) const { return tangential_stiffness_; }
  /// Decay rate of the dashpots of grains with twelve neighbours, moving against the others, 1/s:
  /// 12 c/m, c = 2 zeta sqrt(c_N m/2).
  double viscous_rate(double mass, double /*radius*/ = 0) const {
    return 12 * 2 * damping * std::sqrt(0.5 * normal_stiffness / mass);
  }
  double edge_stiffness(double /*steepness*/) const { return 4 * normal_stiffness; }
  double edge_rate(double mass, double /*steepness*/) const {
    return 4 * damping * std::sqrt(2 * normal_stiffness / mass);
  }

  static constexpr bool in_lanes = true;
  template <int D, class N>
  [[gnu::always_inline]] LawForce<D, N> operator()(const OverlapIn<D, N>& o,
                                                   const ContactMotion<D, N>& m,
                                                   const std::type_identity_t<N>& mu, double dt,
                                                   SpringMemory<D, N>& memory) const {
    const N mass = 1 / m.inverse_mass;
    const N dashpot = 2 * damping * root(N(normal_stiffness * mass));
    const N normal = at_least_zero(N(repulsion(o) + dashpot * m.approach));
    return {normal,
            friction_force(normal, mu, tangential_stiffness_, 0.0, m.slip, dt, memory.spring)};
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
