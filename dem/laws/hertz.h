// Hertz' contact of spheres, with a dashpot, and friction with Mindlin's stiffness.
//
//   a = sqrt(R d), k_n = 2 E* a, k_t = 8 G* a
//   E* = E / (2 (1 - nu^2)), G* = G / (2 (2 - nu)), both bodies of one material
//   F_n = 4/3 E* a d + D v_n
//   dashpots, `damping_model`:
//     critical       D = 2 zeta sqrt(k_n m_eff), tangential 2 zeta sqrt(k_t m_eff)
//     viscoelastic   D = gamma_n a m_eff,        tangential gamma_t a m_eff
//   spring of friction, `tangential_memory`:
//     force          its force advances by -k_t v_t dt, and shrinks with a while the contact
//                    unloads, so that no energy comes from nowhere (Thornton, Cummins, Cleary 2013)
//     displacement   its displacement s advances by v_t dt, its force is -k_t s with k_t as it is:
//                    pressed together after it was sheared, the contact makes energy
// Never attractive. `displacement` and `viscoelastic` are LAMMPS' gran/hertz/history with
// K_n = 4/3 E*, K_t = 8 G*; `force` is its granular's mindlin_rescale/force. The memory is the
// spring's force in both: k_t goes by a, so a displacement that stays is a force that goes by a.
#pragma once
#include "dem/laws/contact.h"
#include "dem/laws/edge_measure.h"
#include "dem/laws/material_setup.h"
#include "dem/words/nearest.h"

namespace grainfield::dem {

/// Spring, and the contact's radius when it was last advanced.
template <int D, class N = double>
struct HertzMemory {
  TangentialOf<D, N> spring = zero<TangentialOf<D, N>>();  ///< its force on i, N
  N contact_radius = zero<N>();                            ///< m

  bool empty() const { return contact_radius == 0 && spring == zero<TangentialOf<D, N>>(); }
  HertzMemory reversed() const { return {-spring, contact_radius}; }
};

struct HertzLaw {
  static constexpr const char* name = "hertz";
  static constexpr Measures measures = Measures::curvature;
  static constexpr EdgeMeasure edges = EdgeMeasure::none;
  template <int D, class N = double>
  using Memory = HertzMemory<D, N>;

  double young = 1e7;    ///< E, Pa
  double poisson = 0.3;  ///< nu, -
  double damping = 0;    ///< zeta, -; 1 is critical

  bool displacement = false;      ///< tangential_memory
  bool viscoelastic = false;      ///< damping_model
  double normal_damping = 0;      ///< gamma_n, 1/(m s); viscoelastic
  double tangential_damping = 0;  ///< gamma_t, 1/(m s); viscoelastic

  /// Throws std::invalid_argument naming material.tangential_memory or material.damping_model.
  static HertzLaw of(const MaterialSetup& m) {
    check_word("material.tangential_memory", m.tangential_memory, {"force", "displacement"});
    check_word("material.damping_model", m.damping_model, {"critical", "viscoelastic"});
    return {m.young,
            m.poisson,
            m.damping,
            m.tangential_memory == "displacement",
            m.damping_model == "viscoelastic",
            m.normal_damping,
            m.tangential_damping};
  }

  double effective_young() const { return young / (2 * (1 - poisson * poisson)); }
  double effective_shear() const { return young / (4 * (1 + poisson) * (2 - poisson)); }

  /// For grains of this radius at kMostDepth of it: the contact's radius, m, and stiffness that
  /// bounds the time step, N/m.
  static constexpr double kMostDepth = 0.02;
  static double most_contact(double radius) { return 0.5 * radius * std::sqrt(2 * kMostDepth); }
  double stiffness(double radius) const { return 2 * effective_young() * most_contact(radius); }
  double tangential_stiffness(double radius) const {
    return stiffness(radius) * 4 * effective_shear() / effective_young();
  }
  /// Decay rate of the dashpots of grains with twelve neighbours, 1/s: moving against the others
  /// 12 c_n/m, or all spinning alike, twice the slip of one and 2/3 of it at the mean contact over
  /// 0.4 m R^2: 40 c_t/m. Viscoelastic c = gamma a m/2, critical c = 2 zeta sqrt(k m/2).
  double viscous_rate(double mass, double radius) const {
    const double spinning =
        viscoelastic ? 20 * tangential_damping * most_contact(radius)
                     : 40 * 2 * damping * std::sqrt(0.5 * tangential_stiffness(radius) / mass);
    return std::max(normal_rate(mass, radius), spinning);
  }
  /// Rate of the normal dashpots alone.
  double normal_rate(double mass, double radius) const {
    return viscoelastic ? 6 * normal_damping * most_contact(radius)
                        : 12 * 2 * damping * std::sqrt(0.5 * stiffness(radius) / mass);
  }
  double edge_stiffness(double /*steepness*/) const { return 0; }
  double edge_rate(double /*mass*/, double /*steepness*/) const { return 0; }

  static constexpr bool in_lanes = true;
  template <int D, class N>
  requires(D == 3) [[gnu::always_inline]] LawForce<D, N> operator()(
      const OverlapIn<D, N>& o, const ContactMotion<D, N>& m, const std::type_identity_t<N>& mu,
      double dt, HertzMemory<D, N>& memory) const {
    using V = VectorOf<D, N>;
    const N mass = 1 / m.inverse_mass;
    const N a = root(N(o.radius * o.depth));
    const N kn = 2 * effective_young() * a, kt = 8 * effective_shear() * a;
    const N across =
        viscoelastic ? N(normal_damping * a * mass) : N(2 * damping * root(N(kn * mass)));
    const N along =
        viscoelastic ? N(tangential_damping * a * mass) : N(2 * damping * root(N(kt * mass)));
    const N normal = at_least_zero(N(kn * (2.0 / 3) * o.depth + across * m.approach));
    if (dt > 0) {
      const N before = memory.contact_radius;
      const auto goes_along = displacement ? (a < before) | (before > 0) : a < before;
      memory.spring = chosen(goes_along, V((a / before) * memory.spring), memory.spring);
      memory.contact_radius = a;
    }
    return {normal, friction_force(normal, mu, kt, along, m.slip, dt, memory.spring)};
  }

  /// The memory of a contact as it is, beside its spring.
  template <int D>
  requires(D == 3) static void take_up(const OverlapIn<D>& o, HertzMemory<D>& memory) {
    memory.contact_radius = std::sqrt(o.radius * o.depth);
  }

  double spring_stiffness(const OverlapIn<3>& o) const {
    return 8 * effective_shear() * std::sqrt(o.radius * o.depth);
  }
  double repulsion(const OverlapIn<3>& o) const {
    return 2 * effective_young() * std::sqrt(o.radius * o.depth) * (2.0 / 3) * o.depth;
  }
  template <int D>
  requires(D == 3) ContactEnergy energy(const OverlapIn<D>& o, const HertzMemory<D>& memory)
  const {
    const double a = std::sqrt(o.radius * o.depth);
    return {2 * effective_young() * a * (4.0 / 15) * o.depth * o.depth,
            spring_energy(memory.spring, 8 * effective_shear() * a)};
  }
  /// What the spring's energy changes by, J, because its stiffness goes with the contact's radius:
  /// after a step, by the memory `before` it. `force`: a loss of either way's; `displacement`: made
  /// while the contact loads.
  template <int D>
  requires(D == 3) double stiffening(const OverlapIn<D>& o, const HertzMemory<D>& before) const {
    if (!(before.contact_radius > 0)) return 0;
    const double a = std::sqrt(o.radius * o.depth), share = a / before.contact_radius;
    const double kept =
        displacement || share < 1 ? share : 1 / share;  // scale^2/share: share may be 0
    return spring_energy(before.spring, 8 * effective_shear() * before.contact_radius) * (kept - 1);
  }
};

}  // namespace grainfield::dem
