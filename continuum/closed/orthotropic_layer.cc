#include "continuum/closed/orthotropic_layer.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

using Gauss = boost::math::quadrature::gauss<double, 30>;

/// Values that differ from the base's height by less than this part of h are on the base.
constexpr double kOnBase = 1e-9;
/// Panels: 30 Gauss points carry 6 rad of cos(k x) and 2 units of u (the integrand's poles are at
/// least 0.9 away from the real axis in an isotropic layer) to round-off.
constexpr double kPanelPhase = 6, kPanelWidth = 2;
/// Nearer to the hyperbolic limit r = -sqrt(t) the integrand decays too slowly to be summed.
constexpr double kLeastRatio = -0.99;

class LayerInPlane : public Model {
 public:
  LayerInPlane(double load, double depth, const Orthotropy& medium, const OrthotropicWaves& waves,
               std::map<std::string, double> figures)
      : load_(load), h_(depth), medium_(medium), waves_(waves), figures_(std::move(figures)) {}

  Stresses stress(const Points& points) override {
    Stresses out = Stresses::Constant(points.rows(), 3, kNan);
    std::vector<Eigen::Index> inside;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const double x = points(i, 0), y = points(i, 1);
      if (y < 0 && y >= -h_ * (1 + kOnBase) && std::isfinite(x)) inside.push_back(i);
    }
    Points there = points(inside, Eigen::all);
    there.col(1) = there.col(1).cwiseMax(-h_);
    out(inside, Eigen::all) = orthotropic_layer_stress(waves_, medium_, load_, h_, there);
    return out;
  }
  std::map<std::string, double> figures() const override { return figures_; }

 private:
  double load_, h_;
  Orthotropy medium_;
  OrthotropicWaves waves_;
  std::map<std::string, double> figures_;
};

std::unique_ptr<Model> make(const Settings& s) {
  const Orthotropy o = orthotropy("orthotropic_layer", s);
  const double least = kLeastRatio * std::sqrt(o.t);
  if (!(o.r > least) || !std::isfinite(o.r + o.t))
    throw BadParameter(
        fmt::format("model orthotropic_layer: r = {:.6g} is too near to the hyperbolic limit; "
                    "allowed: above {:g} sqrt(t) = {:.6g} at t = {:.6g}",
                    o.r, kLeastRatio, least, o.t));
  const double nu = number_of(s, "nu_xy");
  const bool rough = s.at("base") == "rough";
  if (rough && !(o.r + nu > 0 && nu * nu <= o.t))
    throw BadParameter(
        fmt::format("model orthotropic_layer: nu_xy = {:.6g} is of no solid at r = {:.6g}, t = "
                    "{:.6g}; allowed: "
                    "above -r and from -sqrt(t) to sqrt(t)",
                    nu, o.r, o.t));
  return layer_in_plane(number_of(s, "F"), number_of(s, "h"), o, {o, nu, rough},
                        {{"r", o.r}, {"t", o.t}});
}

}  // namespace

OrthotropicWaves::OrthotropicWaves(const Orthotropy& medium, double nu, bool rough, double tail)
    : medium_(medium),
      nu_(nu),
      rough_(rough),
      tail_(tail),
      m_(std::sqrt(0.5 * (medium.r + std::sqrt(medium.t)))),
      square_(0.5 * (medium.r - std::sqrt(medium.t))) {}

double OrthotropicWaves::decay() const {
  return square_ > 0 ? std::sqrt(medium_.t) / (m_ + std::sqrt(square_)) : m_;
}

double OrthotropicWaves::oscillation() const { return square_ < 0 ? std::sqrt(-square_) : 0; }

OrthotropicWaves::Values OrthotropicWaves::pair(double a, double b, double z) const {
  double c = 0, s = 0;
  const double size = std::sqrt(std::fabs(square_)), phase = size * z;
  if (phase < 1e-4) {
    const double e = std::exp(-m_ * z), p2 = square_ * z * z;
    c = e * (1 + p2 / 2);
    s = e * z * (1 + p2 / 6);
  } else if (square_ > 0) {
    const double slow = std::exp((size - m_) * z), fast = std::exp(-(size + m_) * z);
    c = 0.5 * (slow + fast);
    s = 0.5 * (slow - fast) / size;
  } else {
    const double e = std::exp(-m_ * z);
    c = e * std::cos(phase);
    s = e * std::sin(phase) / size;
  }
  // A derivative takes (a, b) to (b - m a, D a - m b).
  Values out{a * c + b * s, 0, 0, 0};
  for (double* v : {&out.g1, &out.g2, &out.g3}) {
    const double next = b - m_ * a;
    b = square_ * a - m_ * b;
    a = next;
    *v = a * c + b * s;
  }
  return out;
}

Eigen::Vector2d OrthotropicWaves::base_conditions(const Values& v) const {
  if (!rough_) return {v.g1, v.g3};
  return {v.g2 + nu_ * v.g, v.g3 - (2 * medium_.r + nu_) * v.g1};
}

OrthotropicWaves::Values OrthotropicWaves::reflected(const Eigen::Vector4d& c, double s,
                                                     double u) const {
  const Values down = pair(c[0], c[1], s), up = pair(c[2], c[3], u - s);
  return {down.g + up.g, down.g1 - up.g1, down.g2 + up.g2, down.g3 - up.g3};
}

Eigen::Vector4d OrthotropicWaves::coefficients(double u) const {
  Eigen::Matrix4d matrix;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector4d unit = Eigen::Vector4d::Unit(k);
    const Values top = reflected(unit, 0, u);
    matrix.col(k) << top.g, top.g1, base_conditions(reflected(unit, u, u));
  }
  Eigen::Vector4d right;
  right << 0, 0, -base_conditions(half_plane(u));
  return matrix.partialPivLu().solve(right);
}

void OrthotropicWaves::add_base(double u, double weight, const Eigen::ArrayXd& share,
                                const Take& take) const {
  const Eigen::Vector4d c = coefficients(u);
  for (Eigen::Index k = 0; k < share.size(); ++k) {
    if (u * decay() * (2 - share[k]) > tail_) continue;
    const Values v = reflected(c, u * share[k], u);
    take(k, u, weight, v.g2, v.g, v.g1);
  }
}

void OrthotropicWaves::integrate_base(const Eigen::ArrayXd& share, double phase,
                                      const Take& take) const {
  const double end = tail_ / (decay() * (2 - share.maxCoeff()));
  // Towards the hyperbolic limit the integrand's poles approach the real axis like the decay.
  const double width =
      std::min({kPanelWidth, kPanelPhase / std::max(phase + 2 * oscillation(), 1e-3),
                kPanelWidth * decay()});
  const int panels = static_cast<int>(std::ceil(end / width));
  const double half = 0.5 * end / panels;
  for (int panel = 0; panel < panels; ++panel) {
    const double middle = (2 * panel + 1) * half;
    for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
      const double aside = half * Gauss::abscissa()[i], weight = half * Gauss::weights()[i];
      add_base(middle + aside, weight, share, take);
      add_base(middle - aside, weight, share, take);
    }
  }
}

Eigen::MatrixX3d OrthotropicWaves::total(double u, const Eigen::VectorXd& share) const {
  const Eigen::Vector4d c = coefficients(u);
  Eigen::MatrixX3d out(share.size(), 3);
  for (Eigen::Index k = 0; k < share.size(); ++k) {
    if (u * decay() * share[k] > tail_) {
      out.row(k).setZero();
      continue;
    }
    // The half plane's pair is (1, m).
    Values v = pair(1 + c[0], m_ + c[1], u * share[k]);
    if (u * decay() * (2 - share[k]) < tail_) {
      const Values up = pair(c[2], c[3], u * (1 - share[k]));
      v = {v.g + up.g, v.g1 - up.g1, v.g2 + up.g2, 0};
    }
    out.row(k) << v.g2, v.g, v.g1;
  }
  return out;
}

Eigen::MatrixX3d orthotropic_layer_stress(const OrthotropicWaves& waves, const Orthotropy& medium,
                                          double F, double h, const Eigen::MatrixXd& points) {
  const auto n = points.rows();
  if (n == 0) return Eigen::MatrixX3d(0, 3);
  const Eigen::ArrayXd x = points.col(0).array() / h, share = -points.col(1).array() / h;
  Eigen::MatrixX3d sum = Eigen::MatrixX3d::Zero(n, 3);
  waves.integrate_base(
      share, x.abs().maxCoeff(),
      [&](Eigen::Index k, double u, double weight, double g2, double g, double g1) {
        const double c = weight * std::cos(u * x[k]), s = weight * std::sin(u * x[k]);
        sum.row(k) += Eigen::RowVector3d(c * g2, c * g, s * g1);
      });
  sum *= F / (std::numbers::pi * h);
  Eigen::MatrixX3d out(n, 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto plane = orthotropic_stress(F, medium, points(k, 0), points(k, 1));
    // sigma_xd changes sign with the axis that points up.
    out.row(k) << plane[0] + sum(k, 0), plane[1] - sum(k, 1), plane[2] - sum(k, 2);
  }
  return out;
}

std::unique_ptr<Model> layer_in_plane(double F, double h, const Orthotropy& medium,
                                      const OrthotropicWaves& waves,
                                      std::map<std::string, double> figures) {
  return std::make_unique<LayerInPlane>(F, h, medium, waves, std::move(figures));
}

ModelInfo orthotropic_layer_info() {
  const char* source = "Otto et al. 2003";
  return {
      "orthotropic_layer",
      "layer with vertical and horizontal elastic axes on a rigid base under a line load",
      2,
      {number("F", "N", "load at the origin, down", "Roul 5.6", 1, 0, kUnbounded),
       number("h", "m", "depth of the layer", "Roul 5.6", 1, kAboveZero, kUnbounded),
       may_be_free(number("r", "-", "(E_x/G - 2 nu_xy)/2, above -0.99 sqrt(t); isotropic: 1",
                          source, 1, -kUnbounded, kUnbounded),
                   -5, 20),
       may_be_free(number("t", "-", "E_x/E_y; isotropic: 1", source, 1, kAboveZero, kUnbounded),
                   0.02, 50, 0),
       optional_number("E_x", "Pa", "with E_y, G and nu_xy instead of r and t", source, kAboveZero,
                       kUnbounded),
       optional_number("E_y", "Pa", "vertical modulus", source, kAboveZero, kUnbounded),
       optional_number("G", "Pa", "shear modulus", source, kAboveZero, kUnbounded),
       may_be_free(
           number("nu_xy", "-",
                  "-eps_yy/eps_xx under sigma_xx in the plane; without E_x, E_y, G it counts on a "
                  "rough base only",
                  source, 0.3, -kUnbounded, kUnbounded),
           -0.95, 0.95),
       choice("base", "smooth: no shear; rough: no displacement", "Roul 5.6", {"smooth", "rough"})},
      make,
      {{"r", "-", "(E_x/G - 2 nu_xy)/2"}, {"t", "-", "E_x/E_y"}},
      ratios_beside_moduli};
}

}  // namespace grainfield::continuum
