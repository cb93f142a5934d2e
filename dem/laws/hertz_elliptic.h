// Hertz' contact of bodies with two curvatures each, with critical damping, and Mindlin's two
// compliances along the axes of the contact ellipse (Wellmann eqs. 9-24).
//
//   F_n = gamma E* d^(3/2) + D v_n, D = 2 zeta sqrt(k_N m_eff), k_N = (3/2) gamma E* sqrt(d)
//   a = axis sqrt(d); gamma, axis, K, B, D by the ratio of the relative curvatures (elliptic.h)
//   C_x = (K l1 - B l2)/(pi a) along the greater semi-axis, C_y = (K l1 - D l2)/(pi a) across it
//   l1 = 2 (1 + nu)/E, l2 = nu l1, 1/E* = 2 (1 - nu^2)/E: both bodies of one material
//   the spring's force advances by -v_x dt/C_x, -v_y dt/C_y, capped at mu F_n
//
// The spring turns with the material (kinematics3.h: turn_with_material), its increments are along
// the axes of the ellipse as it is: where the ellipse turns against the material the force stays,
// and where it is round, and has no axes, nothing depends on them. `tangential_memory` as of hertz:
// the force shrinks with a while the contact unloads, or goes by a always. Never attractive.
//
// Where a surface is flat or has an edge a radius of curvature is infinite or 0, and Hertz'
// paraboloids are none. So radii 1/(2A), 1/(2B) count within least_radius and most_radius times R,
// R = R_i R_j/(R_i + R_j) of the spheres of equal volume, which for spheres they are.
// The force goes by the curvatures, so it changes as the grains roll: it is no gradient, and does
// work round closed paths.
#pragma once
#include <fmt/format.h>

#include <stdexcept>

#include "dem/laws/contact.h"
#include "dem/laws/edge_measure.h"
#include "dem/laws/ellipse_table.h"
#include "dem/laws/hertz.h"
#include "dem/laws/material_setup.h"
#include "dem/words/nearest.h"

namespace grainfield::dem {

struct HertzEllipticLaw {
  static constexpr const char* name = "hertz_elliptic";
  static constexpr Measures measures = Measures::curvatures;
  static constexpr EdgeMeasure edges = EdgeMeasure::none;
  /// contact_radius: the greater semi-axis.
  template <int D>
  using Memory = HertzMemory<D>;

  double young = 1e7;         ///< E, Pa
  double poisson = 0.3;       ///< nu, -
  double damping = 1;         ///< zeta, -; 1 is critical
  bool displacement = false;  ///< tangential_memory
  double least_radius = 0.1;  ///< of 1/(2B) over R, -
  double most_radius = 10;    ///< of 1/(2A) over R, -

  /// Throws std::invalid_argument naming material.tangential_memory, material.poisson or the bounds
  /// of the radii.
  static HertzEllipticLaw of(const MaterialSetup& m) {
    check_word("material.tangential_memory", m.tangential_memory, {"force", "displacement"});
    check_poisson(m.poisson);
    check_radii(m.least_radius, m.most_radius);
    return {m.young,        m.poisson,    m.damping, m.tangential_memory == "displacement",
            m.least_radius, m.most_radius};
  }

  double effective_young() const { return young / (2 * (1 - poisson * poisson)); }
  /// gamma, axis and the ellipse's integrals of a contact within the bounds of the radii.
  EllipticContact ellipse(const Overlap3& o) const {
    const double least = 0.5 / (most_radius * o.radius), most = 0.5 / (least_radius * o.radius);
    const auto within = [&](double c) { return std::min(std::max(c, least), most); };
    return EllipseTable::get().contact(within(o.lesser_curvature), within(o.greater_curvature));
  }
  /// C_x and C_y, m/N, of a contact with the greater semi-axis a, m.
  struct Compliances {
    double major = 0, minor = 0;
  };
  Compliances compliances(const EllipticIntegrals& e, double a) const {
    const double scale = 2 * (1 + poisson) / (young * std::numbers::pi * a);
    return {scale * (e.k - poisson * e.b), scale * (e.k - poisson * e.d)};
  }

  /// As of hertz, of the flattest contacts: both radii of curvature most_radius times that of the
  /// spheres.
  double stiffness(double radius) const { return flattest() * round().stiffness(radius); }
  double tangential_stiffness(double radius) const {
    return flattest() * round().tangential_stiffness(radius);
  }
  /// As of hertz; of the normal dashpots alone, because there are no others.
  double viscous_rate(double mass, double radius) const {
    return 12 * 2 * damping * std::sqrt(0.5 * stiffness(radius) / mass);
  }
  double edge_stiffness(double /*steepness*/) const { return 0; }
  double edge_rate(double /*mass*/, double /*steepness*/) const { return 0; }

  template <int D>
  requires(D == 3) LawForce<D>
  operator()(const OverlapIn<D>& o, const ContactMotion<D>& m, double mu, double dt,
             HertzMemory<D>& memory) const {
    const double mass = 1 / (m.inverse_mass_i + m.inverse_mass_j), root = std::sqrt(o.depth);
    const EllipticContact ellipse = this->ellipse(o);
    const double stiffness = 1.5 * ellipse.gamma * effective_young() * root;
    const double dashpot = 2 * damping * std::sqrt(stiffness * mass);
    const double normal = std::max(stiffness * (2.0 / 3) * o.depth + dashpot * m.approach, 0.0);
    if (dt > 0) {
      const double a = ellipse.axis * root, before = memory.contact_radius;
      if (a < before || (displacement && before > 0)) memory.spring *= a / before;
      memory.contact_radius = a;
      const Compliances c = compliances(ellipse.shape.integrals, a);
      const Eigen::Vector3d minor = o.normal.cross(o.major);
      memory.spring -= (dt * m.slip.dot(o.major) / c.major) * o.major;
      memory.spring -= (dt * m.slip.dot(minor) / c.minor) * minor;
    }
    const double none = 0;
    return {normal, friction_force(normal, mu, none, none, m.slip, none, memory.spring)};
  }

  /// The same for contacts side by side, and the forces at the bodies: contacts 0 to count - 1, for
  /// dt > 0. Those that are `left` are for operator().
  void lanes(const OverlapBatch& o, double mu, double dt, ContactBatch& c, int count) const {
    contact_forces(
        EllipticNumbers{young, effective_young(), poisson, damping, displacement, least_radius,
                        most_radius, mu, dt, EllipseTable::get().coefficients()},
        o, c, count);
  }
  /// The ellipse's table has every ratio of curvatures within the bounds of the radii.
  bool has_lanes() const { return most_radius < EllipseTable::kMostRatio / 2 * least_radius; }

  double repulsion(const Overlap3& o) const {
    return ellipse(o).gamma * effective_young() * o.depth * std::sqrt(o.depth);
  }
  template <int D>
  requires(D == 3) ContactEnergy energy(const OverlapIn<D>& o, const HertzMemory<D>& memory)
  const {
    const EllipticContact ellipse = this->ellipse(o);
    const double root = std::sqrt(o.depth);
    return {0.4 * ellipse.gamma * effective_young() * o.depth * o.depth * root,
            spring_energy_of(memory.spring, o, ellipse, ellipse.axis * root)};
  }
  /// What the spring's energy changes by, J, because its stiffness goes with the contact's size
  /// (hertz.h); what it changes by with the ellipse's direction and ratio is friction's.
  template <int D>
  requires(D == 3) double stiffening(const OverlapIn<D>& o, const HertzMemory<D>& before) const {
    if (!(before.contact_radius > 0)) return 0;
    const EllipticContact ellipse = this->ellipse(o);
    const double share = ellipse.axis * std::sqrt(o.depth) / before.contact_radius;
    const double kept = displacement || share < 1 ? share : 1 / share;
    return spring_energy_of(before.spring, o, ellipse, before.contact_radius) * (kept - 1);
  }

 private:
  static void check_poisson(double nu) {
    if (nu > -1 && nu <= 0.5) return;
    throw std::invalid_argument(
        fmt::format("material.poisson: found {:g}, allowed: above -1, up to 0.5", nu));
  }
  static void check_radii(double least, double most) {
    if (least > 0 && least <= 1 && most >= 1 && std::isfinite(most)) return;
    throw std::invalid_argument(
        fmt::format("material.least_radius, most_radius: found {:g}, {:g}, allowed: above 0 up to "
                    "1, and 1 or more",
                    least, most));
  }
  HertzLaw round() const { return {young, poisson, damping}; }
  double flattest() const { return std::sqrt(most_radius); }
  double spring_energy_of(const Eigen::Vector3d& spring, const Overlap3& o,
                          const EllipticContact& ellipse, double a) const {
    if (!(a > 0)) return 0;
    const Compliances c = compliances(ellipse.shape.integrals, a);
    const double x = spring.dot(o.major), y = spring.dot(o.normal.cross(o.major));
    return 0.5 * (c.major * x * x + c.minor * y * y);
  }
};

}  // namespace grainfield::dem
