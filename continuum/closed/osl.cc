#include "continuum/closed/osl.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

// eta and mu as the user chose them, whichever way.
Closure chosen(const std::string& model, const Settings& s, double phi) {
  const double eta = number_of(s, "eta"), mu = number_of(s, "mu"), K = number_of(s, "K"),
               tau = number_of(s, "tau_deg");
  const bool has_eta = !std::isnan(eta), has_mu = !std::isnan(mu);
  const bool has_K = !std::isnan(K), has_tau = !std::isnan(tau);
  if (has_K != has_tau || (has_K && (has_eta || has_mu))) {
    std::vector<std::string> found;
    for (const char* name : {"eta", "mu", "K", "tau_deg"}) {
      if (!std::isnan(number_of(s, name))) found.emplace_back(name);
    }
    throw BadParameter(
        fmt::format("model {}: found {}; allowed: eta, mu, eta with mu, or K with tau_deg", model,
                    fmt::join(found, " with ")));
  }
  if (has_K) return closure_of({K, tau * kDegree});
  if (has_eta && has_mu) return {eta, mu};
  if (has_eta) return {eta, mu_at_yield(phi, eta)};
  const double free = has_mu ? mu : -std::tan(phi);
  return {eta_at_yield(phi, free), free};
}

void check(const std::string& model, const Settings& s, double phi, const Closure& closure) {
  const double c = 1 / std::tan(phi);
  const std::string found = fmt::format("eta = {:.6g}, mu = {:.6g}", closure.eta, closure.mu);
  if (!(closure.mu < c) || !std::isfinite(closure.eta))
    throw BadParameter(
        fmt::format("model {}: {} has no characteristic inside the heap; allowed: mu below "
                    "cot(phi) = {:.6g} at phi_deg = {}",
                    model, found, c, s.at("phi_deg")));
  const double most = c * (c - closure.mu);
  if (!(closure.eta > 0 && closure.eta < most))
    throw BadParameter(fmt::format(
        "model {}: {} is outside the hyperbolic range of a heap; allowed: eta above 0 and below "
        "cot(phi) (cot(phi) - mu) = {:.6g} at phi_deg = {}",
        model, found, most, s.at("phi_deg")));
}

// Largest |closure_residual| over rho g h, of samples at a depth h = 1.
double off_closure(const HeapField& field, const Closure& closure) {
  constexpr int kSamples = 64;
  const double half = std::tan(field.rays().back());
  double largest = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double x = half * ((2 * i + 1.) / kSamples - 1);
    largest = std::max(largest, std::fabs(closure_residual(closure, field.stress(x, -1), x)));
  }
  return largest / field.rho_g();
}

std::unique_ptr<Model> model_of(double phi, const Closure& closure, double rho_g) {
  auto field = std::make_unique<SectorField>(osl_field(phi, closure, rho_g));
  return std::make_unique<HeapModel>(std::move(field), [=](const HeapField& f) {
    const StressRatio ratio = ratio_of(closure);
    return std::map<std::string, double>{{"eta", closure.eta},
                                         {"mu", closure.mu},
                                         {"K", ratio.K},
                                         {"tau_deg", ratio.tau / kDegree},
                                         {"eta_at_yield", eta_at_yield(phi, closure.mu)},
                                         {"closure_residual", off_closure(f, closure)}};
  });
}

std::vector<Figure> figures() {
  return heap_figures(
      {{"eta", "-", "sigma_xx/sigma_yy without shear"},
       {"mu", "-", "sigma_xx per shear; below 0 a dip"},
       {"eta_at_yield", "-", "the eta with which the slope yields, with this mu"},
       {"K", "-", "ratio of the normal stresses on the fixed axes (Roul 4.23)"},
       {"tau_deg", "deg", "angle of the fixed axes (Roul 4.23)"},
       {"closure_residual", "-",
        "largest |sigma_xx - eta sigma_yy - mu sign(x) sigma_xy| (compression positive, y down) "
        "over rho g h"}});
}

std::unique_ptr<Model> make(const Settings& s) {
  const double phi = number_of(s, "phi_deg") * kDegree;
  return model_of(phi, chosen_closure("osl", s, phi), number_of(s, "rho_g"));
}

}  // namespace

Closure chosen_closure(const std::string& model, const Settings& s, double phi) {
  const Closure closure = chosen(model, s, phi);
  check(model, s, phi, closure);
  return closure;
}

std::vector<Parameter> closure_parameters() {
  return {
      friction_angle(),
      weight(),
      may_be_free(
          optional_number("eta", "-",
                          "unset: as the yielding slope asks for with this mu; both unset: mu = "
                          "-tan(phi), half way between bcc and fpa",
                          "Roul 4.22, 4.24", kAboveZero, kUnbounded),
          0.02, 3),
      may_be_free(optional_number("mu", "-", "unset: as the yielding slope asks for with this eta",
                                  "Roul 4.22, 4.24", -kUnbounded, kUnbounded),
                  -2, 5),
      may_be_free(
          optional_number("K", "-", "with tau_deg instead of eta and mu: sigma_nn = K sigma_mm",
                          "Roul 4.23", kAboveZero, kUnbounded),
          0.02, 20),
      may_be_free(optional_number("tau_deg", "deg", "with K instead of eta and mu: angle of n",
                                  "Roul 4.23", -180, 180),
                  45, 135)};  // as ratio_of has it: mu = 0 is in the middle
}

double Closure::c1() const {
  const double root = std::sqrt(mu * mu + 4 * eta);
  return mu < 0 ? 2 * eta / (root - mu) : (mu + root) / 2;
}

double Closure::c2() const {
  const double root = std::sqrt(mu * mu + 4 * eta);
  return mu > 0 ? -2 * eta / (root + mu) : (mu - root) / 2;
}

double eta_at_yield(double phi, double mu) {
  const double t = std::tan(phi);
  return (1 - mu * t) / (1 + 2 * t * t);
}

double mu_at_yield(double phi, double eta) {
  const double t = std::tan(phi);
  return (1 - eta * (1 + 2 * t * t)) / t;
}

Closure closure_of(const StressRatio& ratio) {
  const double s = std::sin(ratio.tau), c = std::cos(ratio.tau);
  const double divisor = c * c - ratio.K * s * s;
  return {(ratio.K * c * c - s * s) / divisor, 2 * (ratio.K + 1) * s * c / divisor};
}

// The closure says N : sigma = 0 with N = (1, -mu/2; -mu/2, -eta). Its eigenvectors are n and m,
// and K is minus the ratio of its eigenvalues.
StressRatio ratio_of(const Closure& closure) {
  const double trace = 1 - closure.eta, spread = std::hypot(1 + closure.eta, closure.mu);
  const double product = -(closure.eta + closure.mu * closure.mu / 4);
  // Eigenvalue of larger magnitude first, the other from the product.
  const double large = (trace + std::copysign(spread, trace)) / 2, small = product / large;
  const double positive = std::max(large, small), negative = std::min(large, small);
  const double axis = std::atan2(closure.mu, 1 + closure.eta) / 2;
  return {-positive / negative, axis + std::numbers::pi / 2};
}

double closure_residual(const Closure& closure, const Eigen::Vector3d& s, double x) {
  // Compression positive and y down: xx and yy change sign, xy changes it twice.
  return -s[0] + closure.eta * s[1] - closure.mu * (x < 0 ? -s[2] : s[2]);
}

SectorField osl_field(double phi, const Closure& closure, double rho_g) {
  const double c = 1 / std::tan(phi), c1 = closure.c1(), eta = closure.eta, mu = closure.mu;
  const double scale = rho_g * c / ((c - c1) * (c - closure.c2()));
  LinearStress outer, inner;
  // y (1 - S) = -y_up - x / c, y = -y_up.
  outer = scale * Eigen::Vector3d(-eta * c, mu - c, eta) * Eigen::RowVector2d(-1 / c, -1);
  inner << 0, eta * c1, mu / c, c1, eta / c, 0;
  inner *= scale * (c - c1) / c1;
  const double slope = std::numbers::pi / 2 - phi, ray = std::atan(c1);
  return {{{"left outer", -slope, -ray},
           {"left inner", -ray, 0},
           {"right inner", 0, ray},
           {"right outer", ray, slope}},
          {mirrored(outer), mirrored(inner), inner, outer},
          rho_g,
          phi};
}

ModelInfo osl_info() {
  return {
      "osl", "heap with oriented stress linearity, sigma_xx = eta sigma_yy + mu sign(x) sigma_xy",
      2,     closure_parameters(),
      make,  figures()};
}

ModelInfo fpa_info() {
  return {"fpa",
          "heap with fixed principal axes: osl with eta = 1, mu = -2 tan(phi)",
          2,
          {friction_angle(), weight()},
          [](const Settings& s) {
            const double phi = number_of(s, "phi_deg") * kDegree;
            return model_of(phi, {1, -2 * std::tan(phi)}, number_of(s, "rho_g"));
          },
          figures()};
}

ModelInfo bcc_info() {
  return {"bcc",
          "heap with sigma_xx = sigma_yy / (1 + 2 tan^2 phi) (Bouchaud, Cates, Claudin): osl with "
          "mu = 0",
          2,
          {friction_angle(), weight()},
          [](const Settings& s) {
            const double phi = number_of(s, "phi_deg") * kDegree;
            return model_of(phi, {eta_at_yield(phi, 0), 0}, number_of(s, "rho_g"));
          },
          figures()};
}

}  // namespace grainfield::continuum
