// Hertz' contact of spheres, with a dashpot, and friction with Mindlin's stiffness.
//
//   F_n = 4/3 E* sqrt(R) d^{3/2} + D v_n     D = 2 zeta sqrt(k_n m_eff), k_n = 2 E* sqrt(R d)
//   spring k_t = 8 G* sqrt(R d), dashpot 2 zeta sqrt(k_t m_eff)
//   E* = E / (2 (1 - nu^2)), G* = G / (2 (2 - nu)), both bodies of one material
// Never attractive. While the contact unloads, the spring shrinks with its radius sqrt(R d), so
// that no energy comes from nowhere (Thornton, Cummins and Cleary 2013).
#pragma once
#include "dem/laws/contact.h"
#include "dem/laws/material_setup.h"

namespace grainfield::dem {

/// Spring, and the contact's radius when it was last advanced.
template <int D>
struct HertzMemory {
  TangentialOf<D> spring = zero<TangentialOf<D>>();  ///< its force on i, N
  double contact_radius = 0;                         ///< m

  bool empty() const { return contact_radius == 0 && spring == zero<TangentialOf<D>>(); }
  HertzMemory reversed() const { return {-spring, contact_radius}; }
};

struct HertzLaw {
  static constexpr const char* name = "hertz";
  static constexpr bool needs_area = false, needs_curvature = true;
  static constexpr bool feels_edges = false;
  template <int D>
  using Memory = HertzMemory<D>;

  double young = 1e7;    ///< E, Pa
  double poisson = 0.3;  ///< nu, -
  double damping = 0;    ///< zeta, -; 1 is critical

  static HertzLaw of(const MaterialSetup& m) { return {m.young, m.poisson, m.damping}; }

  double effective_young() const { return young / (2 * (1 - poisson * poisson)); }
  double effective_shear() const { return young / (4 * (1 + poisson) * (2 - poisson)); }

  /// Of grains of this radius, at kMostDepth of it: stiffness that bounds the time step, N/m.
  static constexpr double kMostDepth = 0.02;
  double stiffness(double radius) const {
    return 2 * effective_young() * 0.5 * radius * std::sqrt(2 * kMostDepth);
  }
  double tangential_stiffness(double radius) const {
    return stiffness(radius) * 4 * effective_shear() / effective_young();
  }
  /// Decay rate of the dashpots of grains with twelve neighbours, 1/s.
  double viscous_rate(double mass, double radius) const {
    return 12 * 2 * damping * std::sqrt(stiffness(radius) * 0.5 / mass);
  }
  double edge_stiffness(double /*steepness*/) const { return 0; }
  double edge_rate(double /*mass*/, double /*steepness*/) const { return 0; }

  template <int D>
  requires(D == 3) LawForce<D>
  operator()(const OverlapIn<D>& o, const ContactMotion<D>& m, double mu, double dt,
             HertzMemory<D>& memory) const {
    const double mass = 1 / (m.inverse_mass_i + m.inverse_mass_j);
    const double a = std::sqrt(o.radius * o.depth);
    const double kn = 2 * effective_young() * a, kt = 8 * effective_shear() * a;
    const double elastic = kn * (2.0 / 3) * o.depth;
    const double normal = std::max(elastic + 2 * damping * std::sqrt(kn * mass) * m.approach, 0.0);
    if (dt > 0) {
      if (a < memory.contact_radius) memory.spring *= a / memory.contact_radius;
      memory.contact_radius = a;
    }
    return {normal, friction_force(normal, mu, kt, 2 * damping * std::sqrt(kt * mass), m.slip, dt,
                                   memory.spring)};
  }

  /// Elastic energy, J.
  template <int D>
  requires(D == 3) double energy(const OverlapIn<D>& o, const HertzMemory<D>& memory) const {
    const double a = std::sqrt(o.radius * o.depth);
    const double normal = 2 * effective_young() * a * (4.0 / 15) * o.depth * o.depth;
    return normal + 0.5 * memory.spring.squaredNorm() / (8 * effective_shear() * a);
  }
};

}  // namespace grainfield::dem
