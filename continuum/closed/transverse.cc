#include "continuum/closed/transverse.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

using Complex = std::complex<double>;

// Least relative distance of the two g. The stress is even in their difference, so that it is wrong
// by its square; what cancels loses its inverse.
constexpr double kApart = 1e-5;
constexpr const char* kSource = "Elliott 1948";
constexpr double kCancels = 1e-3;  // share that a sum keeps of its terms

class Transverse : public Model {
 public:
  Transverse(double load, const TransverseModuli& moduli) : half_space_(load, moduli) {}
  Stresses stress(const Points& points) override {
    Stresses out = Stresses::Constant(points.rows(), 6, kNan);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      if (!(points(i, 2) < 0)) continue;
      const auto s = half_space_.stress(points(i, 0), points(i, 1), points(i, 2));
      for (int c = 0; c < 6; ++c) out(i, c) = s[static_cast<std::size_t>(c)];
    }
    return out;
  }

 private:
  TransverseHalfSpace half_space_;
};

}  // namespace

bool TransverseModuli::is_stable() const {
  return E_h > 0 && E_v > 0 && G_v > 0 && std::fabs(nu_h) < 1 &&
         1 - nu_h - 2 * nu_v * nu_v * E_h / E_v > 0;
}

PlaneModuli TransverseModuli::plane_strain() const {
  PlaneModuli plane;
  plane.E_x = E_h / (1 - nu_h * nu_h);
  plane.E_y = E_v / (1 - nu_v * nu_v * E_h / E_v);
  plane.nu_xy = plane.E_x * nu_v * (1 + nu_h) / E_v;
  plane.G = G_v;
  return plane;
}

std::vector<Parameter> transverse_parameters() {
  return {
      number("E_h", "Pa", "horizontal Young's modulus; of the moduli only ratios count", kSource, 1,
             kAboveZero, kUnbounded),
      number("E_v", "Pa",
             "vertical Young's modulus; raised: the load is carried nearer to the axis", kSource, 1,
             kAboveZero, kUnbounded),
      number("nu_h", "-", "-eps_yy/eps_xx under sigma_xx", kSource, 0.3, -1, 1),
      number("nu_v", "-", "-eps_xx/eps_zz under sigma_zz", kSource, 0.3, -kUnbounded, kUnbounded),
      optional_number("G_v", "Pa", "shear modulus of vertical planes; unset: E_v/(2 (1 + nu_v))",
                      kSource, kAboveZero, kUnbounded)};
}

TransverseModuli transverse_moduli(const std::string& model, const Settings& s) {
  TransverseModuli m{number_of(s, "E_h"), number_of(s, "E_v"), number_of(s, "nu_h"),
                     number_of(s, "nu_v"), number_of(s, "G_v")};
  if (std::isnan(m.G_v)) m.G_v = m.E_v / (2 * (1 + m.nu_v));
  if (m.is_stable()) return m;
  throw BadParameter(
      fmt::format("model {}: nu_h = {:.6g}, nu_v = {:.6g} with E_h/E_v = {:.6g} is not elastic; "
                  "allowed: G_v above 0, |nu_h| below 1, 2 nu_v^2 E_h/E_v below 1 - nu_h",
                  model, m.nu_h, m.nu_v, m.E_h / m.E_v));
}

Eigen::Matrix<double, 6, 6> TransverseModuli::stiffness() const {
  Eigen::Matrix3d compliance;
  compliance << 1 / E_h, -nu_h / E_h, -nu_v / E_v,  //
      -nu_h / E_h, 1 / E_h, -nu_v / E_v,            //
      -nu_v / E_v, -nu_v / E_v, 1 / E_v;
  Eigen::Matrix<double, 6, 6> c = Eigen::Matrix<double, 6, 6>::Zero();
  c.topLeftCorner<3, 3>() = compliance.inverse();
  c(3, 3) = c(4, 4) = G_v;
  c(5, 5) = E_h / (2 * (1 + nu_h));
  return c;
}

TransverseHalfSpace::TransverseHalfSpace(double F, const TransverseModuli& m) {
  const Eigen::Matrix<double, 6, 6> c = m.stiffness();
  const double c11 = c(0, 0), c13 = c(0, 2), c33 = c(2, 2), c44 = m.G_v;
  plane_ = m.E_h / (1 + m.nu_h);
  // n1 n2 = c33/c11 and (sqrt n1 + sqrt n2)^2 = n1 + n2 + 2 sqrt(n1 n2).
  const double sum = (c11 * c33 - c13 * (c13 + 2 * c44)) / (c11 * c44);
  const double product = std::sqrt(c33 / c11);
  const Complex mean = std::sqrt(Complex(sum + 2 * product)) / 2.0;
  const Complex half = std::sqrt(Complex(sum - 2 * product)) / 2.0;
  std::array<Complex, 2> g{1.0 / (mean + half), 1.0 / (mean - half)};
  const Complex middle = (g[0] + g[1]) / 2.0;
  if (std::abs(g[0] - g[1]) < kApart * std::abs(middle)) {
    g = {middle * (1 + kApart / 2), middle * (1 - kApart / 2)};
  }
  for (std::size_t i = 0; i < 2; ++i) {
    Term& term = terms_[i];
    const Complex other = g[1 - i], n = 1.0 / (g[i] * g[i]);
    term.g = g[i];
    term.a = F / (2 * std::numbers::pi) * other / (other - g[i]);
    // 1 + k = (c13 + c11 n)/(c13 + c44) = (c33 + c13 n)/(c33 - c44 n). Where c13 = -c44 the first
    // is 0/0 for one root; elsewhere both terms take it, for they are to be even in the g's
    // difference.
    const Complex first = c13 + c11 * n;
    const bool cancels = std::abs(first) < kCancels * (std::fabs(c13) + c11 * std::abs(n));
    term.A = term.a / c44 * (cancels ? (c33 - c44 * n) / (c33 + c13 * n) : (c13 + c44) / first);
    term.down = term.a / c44 - term.A;
  }
}

std::array<double, 6> TransverseHalfSpace::stress(double x, double y, double z) const {
  const double r = std::hypot(x, y);
  Complex zz = 0, shear = 0, hoop = 0, across = 0;
  for (const Term& t : terms_) {
    const Complex depth = -t.g * z, R = std::sqrt(r * r + depth * depth), cube = R * R * R;
    const Complex potential = t.A / (R * (R + depth));
    zz -= t.a * depth / cube;
    shear += t.a * t.g / cube;
    hoop += (t.a * t.g * t.g - plane_ * t.A) * depth / cube + plane_ * potential;
    // (s_rr - s_tt)/r^2 for s_xx = s_tt + (s_rr - s_tt) x^2/r^2; its two parts cancel at the axis:
    // -2/(R (R + z)) + z/R^3 over r^2 is
    // -(2 R + z)/(R^3 (R + z)^2).
    const Complex sum = R + depth;
    across -= plane_ * t.A * (2.0 * R + depth) / (cube * sum * sum);
  }
  const double tt = hoop.real(), turn = across.real();
  return {tt + turn * x * x, tt + turn * y * y, zz.real(),
          shear.real() * y,  shear.real() * x,  turn * x * y};
}

std::array<double, 3> TransverseHalfSpace::displacement(double x, double y, double z) const {
  Complex side = 0, down = 0;
  for (const Term& t : terms_) {
    const Complex depth = -t.g * z, R = std::sqrt(x * x + y * y + depth * depth);
    side += t.A / (R * (R + depth));
    down += t.down * t.g / R;
  }
  return {side.real() * x, side.real() * y, -down.real()};
}

ModelInfo transverse_half_space_info() {
  std::vector<Parameter> parameters{
      number("F", "N", "load at the origin, down", kSource, 1, 0, kUnbounded)};
  for (Parameter& p : transverse_parameters()) parameters.push_back(std::move(p));
  return {"transverse_half_space",
          "elastic half space with a vertical axis of symmetry under a point load", 3,
          std::move(parameters), [](const Settings& s) -> std::unique_ptr<Model> {
            return std::make_unique<Transverse>(number_of(s, "F"),
                                                transverse_moduli("transverse_half_space", s));
          }};
}

}  // namespace grainfield::continuum
