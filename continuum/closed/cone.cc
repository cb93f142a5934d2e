#include "continuum/closed/cone.h"

#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_times.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/generation/make_dense_output.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

using State = std::array<double, 2>;

constexpr int kNodes = 801;
constexpr double kLast = 1e-4;  // t nearest to S0; nearer the equations are 0/0
constexpr double kStep = (1 - kLast) / (kNodes - 1);
constexpr double kTolerance = 1e-13;  // of the integration, per step

template <class Cone>
class ConeModel : public Model {
 public:
  ConeModel(double phi, Cone cone) : cone_(std::move(cone)), phi_(phi) {}

  Stresses stress(const Points& points) override {
    Stresses out(points.rows(), 6);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const auto s = cone_.stress(points(i, 0), points(i, 1), points(i, 2));
      for (int c = 0; c < 6; ++c) out(i, c) = s[static_cast<std::size_t>(c)];
    }
    return out;
  }

  std::map<std::string, double> figures() const override {
    constexpr int kSamples = 1000;
    double largest = 0, at = 0;
    for (int k = 0; k <= kSamples; ++k) {
      const double S = static_cast<double>(k) / kSamples, p = cone_.reduced(S)[1];
      if (p <= largest) continue;
      largest = p;
      at = S;
    }
    const double centre = cone_.reduced(0)[1];
    return {{"eta", cone_.closure().eta},
            {"mu", cone_.closure().mu},
            {"eta_at_yield", eta_at_yield(phi_, cone_.closure().mu)},
            {"base_centre", centre},
            {"base_largest", largest},
            {"base_largest_at", at},
            {"dip_ratio", centre / largest}};
  }

 private:
  Cone cone_;
  double phi_;
};

std::vector<Figure> figures() {
  return {{"eta", "-", "sigma_rr/sigma_zz without shear"},
          {"mu", "-", "sigma_rr per shear; below 0 a dip"},
          {"eta_at_yield", "-", "the eta with which the slope yields, with this mu"},
          {"base_centre", "-", "pressure on the base at its centre over rho g h"},
          {"base_largest", "-", "largest pressure on the base over rho g h"},
          {"base_largest_at", "-", "its distance from the axis over the radius of the base"},
          {"dip_ratio", "-", "base_centre over base_largest"}};
}

template <class Chosen>
std::unique_ptr<Model> cone(const Settings& s, const Chosen& closure) {
  const double phi = number_of(s, "phi_deg") * kDegree;
  return std::make_unique<ConeModel<OslCone>>(phi,
                                              OslCone(phi, closure(phi), number_of(s, "rho_g")));
}

/// Stress in the project's axes of a cone without size by its reduced stress at S (rr, zz, rz) and
/// the share of s_zz in s_tt, whose other part is s_rr. z up changes the sign of rz, tension that
/// of all.
template <class Reduced>
std::array<double, 6> in_space(double x, double y, double z, double tangent, double rho_g,
                               double zz_in_tt, const Reduced& reduced) {
  const double r = std::hypot(x, y), depth = -z;
  if (!(depth >= 0 && r * tangent <= depth)) return {kNan, kNan, kNan, kNan, kNan, kNan};
  if (depth == 0) return {0, 0, 0, 0, 0, 0};
  const auto [rr, zz, rz] = reduced(r * tangent / depth);
  const double unit = rho_g * depth;
  const double shear = r > 0 ? unit * rz / r : 0;
  const double more = unit * zz_in_tt * (rr - zz);  // s_rr - s_tt, which is 0 on the axis
  const double tt = -unit * (rr + zz_in_tt * (zz - rr));
  const double c = r > 0 ? x / r : 0, d = r > 0 ? y / r : 0;
  return {tt - more * c * c, tt - more * d * d, -unit * zz, shear * y, shear * x, 0 - more * c * d};
}

}  // namespace

OslCone::OslCone(double phi, const Closure& closure, double rho_g)
    : tangent_(std::tan(phi)),
      rho_g_(rho_g),
      singular_(tangent_ * closure.c1()),
      closure_(closure) {
  integrate();
  const double kink = closure.mu * singular_ / (2 * tangent_ * closure.eta);  // above -1/2
  centre_ = (outer(singular_)[0] + kink) / (1 + kink);
}

std::array<double, 2> OslCone::derivative(double S, const std::array<double, 2>& y) const {
  const double c = tangent_, eta = closure_.eta, mu = closure_.mu;
  const double first = -y[1], second = 1 - y[0] - c * y[1] / S;
  // c^2 eta + c mu S - S^2 without cancellation about S0, its other root is c c2.
  const double determinant = -(S - singular_) * (S - c * closure_.c2());
  return {(c * first - (c * mu - S) * second) / determinant,
          (c * eta * second + S * first) / determinant};
}

void OslCone::integrate() {
  const double side = 1 - singular_;
  const auto system = [&](const State& y, State& slope, double t) {
    slope = derivative(singular_ + side * t * t, y);
    for (double& v : slope) v *= 2 * side * t;
  };
  std::vector<double> times;
  for (int k = 0; k < kNodes; ++k) times.push_back(1 - k * kStep);
  using Stepper = boost::numeric::odeint::runge_kutta_dopri5<State>;
  State start{0, 0};
  boost::numeric::odeint::integrate_times(
      boost::numeric::odeint::make_dense_output(kTolerance, kTolerance, Stepper()), system, start,
      times.begin(), times.end(), -kStep, [&](const State& y, double t) {
        State slope;
        system(y, slope, t);
        value_.push_back(y);
        slope_.push_back(slope);
      });
}

// Cubic Hermite; beyond the last node straight on.
std::array<double, 2> OslCone::outer(double S) const {
  const double t = std::sqrt(std::max(0.0, (S - singular_) / (1 - singular_)));
  const double u = (1 - t) / kStep;
  const std::size_t k = std::min(static_cast<std::size_t>(u), value_.size() - 1);
  const double v = u - static_cast<double>(k), w = 1 - v;
  State out;
  for (std::size_t c = 0; c < 2; ++c) {
    out[c] = k + 1 == value_.size()
                 ? value_[k][c] - v * kStep * slope_[k][c]
                 : w * w * (1 + 2 * v) * value_[k][c] + v * v * (1 + 2 * w) * value_[k + 1][c] -
                       kStep * v * w * (w * slope_[k][c] - v * slope_[k + 1][c]);
  }
  return out;
}

std::array<double, 3> OslCone::reduced(double S) const {
  double p = 0, q = 0;
  if (S >= singular_) {
    const State there = outer(S);
    p = there[0];
    q = there[1];
  } else {
    const double a = (1 - centre_) / (2 * tangent_);
    p = centre_ - a * closure_.mu / closure_.eta * S;
    q = a * S;
  }
  return {closure_.eta * p + closure_.mu * q, p, q};
}

std::array<double, 6> OslCone::stress(double x, double y, double z) const {
  return in_space(x, y, z, tangent_, rho_g_, 0, [&](double S) { return reduced(S); });
}

LevyCone::LevyCone(double phi, double rho_g)
    : phi_(phi),
      tangent_(std::tan(phi)),
      rho_g_(rho_g),
      closure_{1, -2 * tangent_},
      singular_(tangent_ * closure_.c1()) {}

std::array<double, 3> LevyCone::reduced(double S) const {
  const double c = tangent_, sine = std::sin(phi_), cosine = std::cos(phi_);
  double p = 1 - std::numbers::pi / 2 * sine * (1 - 1.5 * S);
  double q = std::numbers::pi / 4 * cosine * S;
  if (S > singular_) {
    const double u = std::asin(std::min(1.0, sine * (1 / S - 1)));
    const double cubed = cosine * cosine * cosine;
    const double integral = (u + std::sin(u) * std::cos(u)) / (2 * sine * cosine);
    const double D = (S - singular_) * (S - c * closure_.c2());
    p = 1 - cubed * (D * std::sqrt(D) / (S * S) + 2 * c * c * (1 - 1.5 * S) * integral);
    q = cubed * c * S * integral;
  }
  return {p + closure_.mu * q, p, q};
}

std::array<double, 6> LevyCone::stress(double x, double y, double z) const {
  return in_space(x, y, z, tangent_, rho_g_, 0.5, [&](double S) { return reduced(S); });
}

ModelInfo cone_osl_info() {
  return {"cone_osl",
          "cone with oriented stress linearity, sigma_rr = eta sigma_zz + mu sigma_rz, sigma_tt = "
          "sigma_rr",
          3,
          closure_parameters(),
          [](const Settings& s) {
            return cone(s, [&](double phi) { return chosen_closure("cone_osl", s, phi); });
          },
          figures()};
}

ModelInfo cone_fpa_info() {
  return {"cone_fpa",
          "cone with fixed principal axes: cone_osl with eta = 1, mu = -2 tan(phi)",
          3,
          {friction_angle(), weight()},
          [](const Settings& s) {
            return cone(s, [](double phi) { return Closure{1, -2 * std::tan(phi)}; });
          },
          figures()};
}

ModelInfo cone_fpa_levy_info() {
  return {"cone_fpa_levy",
          "cone with fixed principal axes as cone_fpa, but sigma_tt = (sigma_rr + sigma_zz)/2 "
          "(Levy)",
          3,
          {friction_angle(), weight()},
          [](const Settings& s) -> std::unique_ptr<Model> {
            const double phi = number_of(s, "phi_deg") * kDegree;
            return std::make_unique<ConeModel<LevyCone>>(phi, LevyCone(phi, number_of(s, "rho_g")));
          },
          figures()};
}

ModelInfo cone_bcc_info() {
  return {"cone_bcc",
          "cone with sigma_rr = sigma_zz / (1 + 2 tan^2 phi): cone_osl with mu = 0",
          3,
          {friction_angle(), weight()},
          [](const Settings& s) {
            return cone(s, [](double phi) { return Closure{eta_at_yield(phi, 0), 0}; });
          },
          figures()};
}

}  // namespace grainfield::continuum
