#include "continuum/closed/orthotropic.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <limits>

#include "continuum/closed/models.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

/// Bisections of the integral along the angle, where strains are steep, and its relative error.
constexpr unsigned kIntegralDepth = 12;
constexpr double kIntegralTolerance = 1e-11;

class OrthotropicHalfPlane : public Model {
 public:
  OrthotropicHalfPlane(double load, const Orthotropy& o) : load_(load), o_(o) {}
  Stresses stress(const Points& points) override {
    Stresses out = Stresses::Constant(points.rows(), 3, std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      if (!(points(i, 1) < 0)) continue;
      const auto s = orthotropic_stress(load_, o_, points(i, 0), points(i, 1));
      for (int c = 0; c < 3; ++c) out(i, c) = s[static_cast<std::size_t>(c)];
    }
    return out;
  }
  std::map<std::string, double> figures() const override {
    return {{"r", o_.r},
            {"t", o_.t},
            {"peaks", o_.r < 0 ? 2 : 1},
            {"peak_at_over_depth", o_.r < 0 ? std::sqrt(-o_.r) : 0}};
  }

 private:
  double load_;
  Orthotropy o_;
};

std::unique_ptr<Model> make(const Settings& s) {
  const Orthotropy o = orthotropy("orthotropic_half_plane", s);
  const double least = -std::sqrt(o.t);
  if (!(o.r > least) || !std::isfinite(o.r + o.t))
    throw BadParameter(
        fmt::format("model orthotropic_half_plane: r = {:.6g} is not elastic; allowed: above "
                    "-sqrt(t) = {:.6g} at t = {:.6g}",
                    o.r, least, o.t));
  return std::make_unique<OrthotropicHalfPlane>(number_of(s, "F"), o);
}

}  // namespace

Orthotropy orthotropy(const std::string& model, const Settings& s) {
  const double E_x = number_of(s, "E_x"), E_y = number_of(s, "E_y"), G = number_of(s, "G");
  const int set = !std::isnan(E_x) + !std::isnan(E_y) + !std::isnan(G);
  if (set == 3) return orthotropy(E_x, E_y, number_of(s, "nu_xy"), G);
  if (set == 0) return {number_of(s, "r"), number_of(s, "t")};
  throw BadParameter(fmt::format(
      "model {}: found {} of E_x, E_y, G; allowed: all three, with nu_xy, or none, with r and t",
      model, set));
}

PlaneModuli plane_strain_moduli(double E, double nu) {
  return {E / (1 - nu * nu), E / (1 - nu * nu), nu / (1 - nu), E / (2 * (1 + nu))};
}

Eigen::Matrix3d compliance(const PlaneModuli& m) {
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  s(0, 0) = 1 / m.E_x;
  s(1, 1) = 1 / m.E_y;
  s(0, 1) = s(1, 0) = -m.nu_xy / m.E_x;
  s(2, 2) = 1 / m.G;
  return s;
}

Eigen::Matrix3d stiffness(const PlaneModuli& m) { return compliance(m).inverse(); }

bool is_stable(const PlaneModuli& m) {
  return m.E_x > 0 && m.E_y > 0 && m.G > 0 && m.nu_xy * m.nu_xy < m.E_x / m.E_y;
}

std::array<double, 2> orthotropic_displacement(double F, const PlaneModuli& moduli, double x,
                                               double y) {
  const Orthotropy o = orthotropy(moduli);
  const Eigen::Matrix3d s = compliance(moduli);
  // Angle from the downward axis towards +x; radial direction (sin, -cos), tangential (cos, sin).
  const auto strain = [&](double angle) -> Eigen::Vector3d {
    const auto stress = orthotropic_stress(F, o, std::sin(angle), -std::cos(angle));
    return s * Eigen::Vector3d(stress[0], stress[1], stress[2]);
  };
  const double c = -strain(0)[1];
  // g' = e_tt (tangential) + (2 e_rt - c . tangential) (radial).
  const auto derivative = [&](double angle, int axis) {
    const Eigen::Vector3d e = strain(angle);
    const double sine = std::sin(angle), cosine = std::cos(angle);
    const double tangential = e[0] * cosine * cosine + e[1] * sine * sine + e[2] * sine * cosine;
    const double shear = 2 * (e[0] - e[1]) * sine * cosine + e[2] * (sine * sine - cosine * cosine);
    const double radial = shear - c * sine;
    return axis == 0 ? tangential * cosine + radial * sine : tangential * sine - radial * cosine;
  };
  const double angle = std::atan2(x, -y);
  std::array<double, 2> u{};
  for (int axis = 0; axis < 2; ++axis) {
    u[static_cast<std::size_t>(axis)] =
        boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
            [&](double a) { return derivative(a, axis); }, 0., angle, kIntegralDepth,
            kIntegralTolerance);
  }
  u[1] += c * std::log(std::hypot(x, y));
  return u;
}

std::string ratios_beside_moduli(const std::string& parameter, const Settings& s) {
  if (parameter != "r" && parameter != "t") return {};
  for (const char* modulus : {"E_x", "E_y", "G"})
    if (!std::isnan(number_of(s, modulus)))
      return fmt::format("beside {} = {}, which replaces it; leave it out, or E_x, E_y and G",
                         modulus, s.at(modulus));
  return {};
}

ModelInfo orthotropic_half_plane_info() {
  const char* source = "Otto et al. 2003";
  return {
      "orthotropic_half_plane",
      "half plane with vertical and horizontal elastic axes under a line load",
      2,
      {number("F", "N", "load at the origin, down", "Roul 5.2", 1, 0, kUnbounded),
       may_be_free(
           number("r", "-", "(E_x/G - 2 nu_xy)/2, above -sqrt(t); below 0: two peaks; isotropic: 1",
                  source, 1, -kUnbounded, kUnbounded),
           -5, 20),
       may_be_free(number("t", "-", "E_x/E_y; isotropic: 1", source, 1, kAboveZero, kUnbounded),
                   0.02, 50, 0),
       optional_number("E_x", "Pa", "with E_y, G and nu_xy instead of r and t", source, kAboveZero,
                       kUnbounded),
       optional_number("E_y", "Pa", "vertical modulus", source, kAboveZero, kUnbounded),
       optional_number("G", "Pa", "shear modulus", source, kAboveZero, kUnbounded),
       number("nu_xy", "-", "-eps_yy/eps_xx under sigma_xx; counts with E_x, E_y, G only", source,
              0.3, -kUnbounded, kUnbounded)},
      make,
      {{"r", "-", "(E_x/G - 2 nu_xy)/2"},
       {"t", "-", "E_x/E_y"},
       {"peaks", "-", "peaks of the pressure at any depth"},
       {"peak_at_over_depth", "-", "their distance from the axis over the depth"}},
      [](const std::string& parameter, const Settings& s) -> std::string {
        // In a closed layer nu_xy counts on a rough base, which a run may fill in later: it is not
        // refused there.
        if (parameter == "nu_xy" && std::isnan(number_of(s, "E_x")))
          return "beside r and t; leave it out or set E_x, E_y and G";
        return ratios_beside_moduli(parameter, s);
      }};
}

}  // namespace grainfield::continuum
