#include "coupling/studies/pair/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/laws/restitution.h"

namespace grainfield::coupling {
namespace {

constexpr double kDegrees = std::numbers::pi / 180;
// Springs whose stiffnesses miss the ratio that swings in step by less than this share of it:
// stiffnesses are written with a few digits. cos(pi sqrt(x)) at x = 1 then misses -1 by less than
// the square of it.
constexpr double kInStep = 1e-6;

bool is_round(const dem::PairSetup& s) { return s.shape == "disk" || s.shape == "sphere"; }

bool is_zero(const std::vector<double>& spin) {
  return std::all_of(spin.begin(), spin.end(), [](double w) { return w == 0; });
}

// Effective mass and radius.
struct PairScales {
  double mass = 0, radius = 0;
};

PairScales scales_of(const dem::PairSetup& s) {
  const auto mass = [&](double r) {
    const double pi = std::numbers::pi;
    return s.material.density * (s.is_3d() ? 4.0 / 3 * pi * r * r * r : pi * r * r);
  };
  const double a = s.radius, b = s.radius_second > 0 ? s.radius_second : a;
  if (s.partner == "wall") return {mass(a), a};
  return {mass(a) * mass(b) / (mass(a) + mass(b)), a * b / (a + b)};
}

// K d^n + c d^{(n-1)/2} v; a power of 0: none.
struct PowerForce {
  double power = 0, stiffness = 0, dashpot = 0;
};

PowerForce force_of(const dem::PairSetup& s) {
  const dem::MaterialSetup& m = s.material;
  const auto [mass, radius] = scales_of(s);
  if (!is_round(s)) return {};
  if (m.law == "linear") return {1, m.normal_stiffness, mass * m.normal_damping};
  if (m.law == "hertz" && (m.damping_model == "critical" || m.normal_damping == 0)) {
    const double young = m.young / (2 * (1 - m.poisson * m.poisson)), root = std::sqrt(radius);
    const double zeta = m.damping_model == "critical" ? m.damping : 0;
    return {1.5, 4.0 / 3 * young * root, 2 * zeta * std::sqrt(2 * young * root * mass)};
  }
  if (m.law == "energy" && m.energy == "square") {
    return {2, 16.0 / 3 * m.young / radius, 2 * m.damping * std::sqrt(2 * m.young * mass / radius)};
  }
  if (m.law == "overlap_area" && m.damping == 0) {
    return {1.5, 4.0 / 3 * std::sqrt(2 / radius) * m.young, 0};
  }
  return {};
}

// Largest x over x'(0)/w0.
double peak_of_dashpot(double share) {
  const double rest = 1 - share * share;
  if (share == 0) return 1;
  if (rest > 0) return std::exp(-share / std::sqrt(rest) * std::atan2(std::sqrt(rest), share));
  const double w = std::sqrt(-rest);
  return w > 0 ? std::exp(-share / w * std::atanh(w / share)) : std::exp(-1.0);
}

double slip_ratio(const dem::PairSetup& s) { return s.is_3d() ? 3.5 : 3; }  // m/m_t

// Linear law without dashpots.
double elastic_slip(const dem::PairSetup& s, double angle_deg) {
  const double ratio = slip_ratio(s), mu = s.material.friction;
  const double springs = s.material.normal_stiffness / s.material.tangential_stiffness;
  const double slope = std::tan(std::fabs(angle_deg) * kDegrees);
  if (slope >= mu * std::max(springs, 2 * ratio - springs)) {
    return restitution_of_slip(s, 1, angle_deg);
  }
  return std::fabs(springs / ratio - 1) < kInStep ? 1 : PairClosedForm::kNone;
}

// Round bodies that meet head on.
bool head_on(const dem::PairSetup& s) {
  return s.kind == "collision" && is_round(s) && s.offset == 0 && is_zero(s.spin_first) &&
         is_zero(s.spin_second);
}

}  // namespace

double restitution_of_slip(const dem::PairSetup& setup, double restitution_normal,
                           double angle_deg) {
  if (!head_on(setup) || setup.material.rolling_friction > 0) return PairClosedForm::kNone;
  return -1 + setup.material.friction * (1 + restitution_normal) * slip_ratio(setup) /
                  std::tan(std::fabs(angle_deg) * kDegrees);
}

double pair_elastic_force(const dem::PairSetup& setup, double depth) {
  const PowerForce f = force_of(setup);
  return f.power > 0 ? f.stiffness * std::pow(depth, f.power) : PairClosedForm::kNone;
}

PairClosedForm pair_closed_form(const dem::PairSetup& s, double speed, double angle_deg) {
  PairClosedForm out;
  const PowerForce f = force_of(s);
  if (f.power == 0 || !head_on(s) || s.motion.local_damping > 0) return out;
  const double mass = scales_of(s).mass, approach = speed * std::cos(angle_deg * kDegrees);
  const double half = 0.5 * (f.power + 1);
  const double frequency = std::sqrt(half * f.stiffness / mass);
  const double share = f.dashpot / (2 * mass) / frequency;
  out.restitution_normal = dem::restitution_of_dashpot(share);
  out.max_depth = std::pow(peak_of_dashpot(share) * half * approach / frequency, 1 / half);
  if (f.dashpot == 0) {
    const double inverse = 1 / (f.power + 1);
    out.duration = 2 * out.max_depth / approach * std::sqrt(std::numbers::pi) *
                   std::tgamma(1 + inverse) / std::tgamma(0.5 + inverse);
    out.max_force = f.stiffness * std::pow(out.max_depth, f.power);
  } else if (f.power == 1) {
    out.duration = dem::time_of_dashpot(share) / frequency;
  }
  const dem::MaterialSetup& m = s.material;
  if (m.law == "linear" && angle_deg != 0 && m.normal_damping == 0 && m.tangential_damping == 0 &&
      m.rolling_friction == 0) {
    out.restitution_tangential = elastic_slip(s, angle_deg);
  }
  return out;
}

}  // namespace grainfield::coupling
