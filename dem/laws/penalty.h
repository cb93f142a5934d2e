// Linear spring on the overlap depth with a dashpot by its own critical damping, and friction
// without one (Wellmann eqs. 5-8).
//
//   F_n = c_N d + D v_n, D = 2 zeta sqrt(c_N m_eff)   (never attractive)
//   spring c_T v_t dt, capped at mu F_n
#pragma once
#include "dem/laws/contact.h"
#include "dem/laws/contact_lanes.h"
#include "dem/laws/edge_measure.h"
#include "dem/laws/material_setup.h"
#include "dem/laws/sphere_lanes.h"

namespace grainfield::dem {

struct PenaltyLaw {
  static constexpr const char* name = "penalty";
  static constexpr Measures measures = Measures::depth;
  static constexpr EdgeMeasure edges = EdgeMeasure::none;
  template <int D>
  using Memory = SpringMemory<D>;
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

  template <int D>
  LawForce<D> operator()(const OverlapIn<D>& o, const ContactMotion<D>& m, double mu, double dt,
                         SpringMemory<D>& memory) const {
    const double mass = 1 / (m.inverse_mass_i + m.inverse_mass_j);
    const double dashpot = 2 * damping * std::sqrt(normal_stiffness * mass);
    const double normal = std::max(repulsion(o) + dashpot * m.approach, 0.0);
    return {normal,
            friction_force(normal, mu, tangential_stiffness_, 0.0, m.slip, dt, memory.spring)};
  }

  /// The same for contacts side by side, as of hertz_elliptic.
  void lanes(const OverlapBatch& o, double mu, double dt, ContactBatch& c, int count) const {
    contact_forces(PenaltyNumbers{normal_stiffness, tangential_stiffness_, damping, mu, dt}, o, c,
                   count);
  }
  static constexpr bool has_lanes() { return true; }
  /// And for spheres.
  static constexpr SphereLawKind sphere_kind = SphereLawKind::penalty;
  RoundNumbers round_numbers(double mu, double dt) const {
    return {sphere_kind, normal_stiffness, tangential_stiffness_, 2 * damping, 0, false, false, mu,
            dt};
  }

  double spring_stiffness(const auto& /*o*/) const { return tangential_stiffness_; }
  double repulsion(const auto& o) const { return normal_stiffness * o.depth; }
  template <int D>
  ContactEnergy energy(const OverlapIn<D>& o, const SpringMemory<D>& memory) const {
    return {0.5 * normal_stiffness * o.depth * o.depth,
            spring_energy(memory.spring, tangential_stiffness_)};
  }
};

}  // namespace grainfield::dem
