#include "dem/laws/material_defaults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "dem/laws/hertz.h"

namespace grainfield::dem {
namespace {

// Restitutions written with three digits agree with a dashpot that was computed from them.
constexpr double kSameRestitution = 5e-4;
// A restitution that follows is for people: as written, it must not change when it is read again.
constexpr double kShown = 1e9;
// Restitution of a dashpot far beyond critical: what a key still takes.
constexpr double kLeastRestitution = 1e-12;

// A dashpot of a material: which member holds it, and by what it is multiplied to be the share of
// the critical one that restitution_of_dashpot() takes.
struct Dashpot {
  const char* name;
  double MaterialSetup::*member;
  double share;
};

std::optional<Dashpot> dashpot_of(const MaterialSetup& m, const RoundGrain& grain) {
  if (m.law == "penalty") return Dashpot{"damping", &MaterialSetup::damping, 1};
  // Physics as in pair/closed_forms.h.
  const Dashpot hertz{"damping", &MaterialSetup::damping, std::sqrt(6.0 / 5)};
  if (m.law == "hertz_elliptic") return hertz;
  if (m.law == "hertz" && m.damping_model == "critical") return hertz;
  if (m.law != "linear" && m.law != "hertz") return {};
  if (!(grain.radius > 0)) return {};
  const double mass = 0.5 * mass_of(grain, m.density);
  if (m.law == "linear") {
    return Dashpot{"normal_damping", &MaterialSetup::normal_damping,
                   0.5 * std::sqrt(mass / m.normal_stiffness)};
  }
  // zeta = gamma_n a m/(2 sqrt(k_n m)).
  const double a = HertzLaw::most_contact(grain.radius);
  const double stiffness = HertzLaw::of(m).stiffness(grain.radius);
  return Dashpot{"normal_damping", &MaterialSetup::normal_damping,
                 std::sqrt(6.0 / 5) * 0.5 * a * std::sqrt(mass / stiffness)};
}

}  // namespace

void follow_defaults(MaterialSetup& m, const MaterialSetup& usual, const IsGiven& given,
                     const RoundGrain& grain) {
  if (!given("restitution")) m.restitution = usual.restitution;
  if (!given("damping")) m.damping = usual.damping;
  if (!given("normal_damping")) m.normal_damping = usual.normal_damping;
  if (!given("tangential_stiffness")) m.tangential_stiffness = 2 * m.normal_stiffness / 7;
  if (const auto dashpot = dashpot_of(m, grain)) {
    double& held = m.*(dashpot->member);
    const bool by_rate = dashpot->member == &MaterialSetup::normal_damping;
    const double now = restitution_of_dashpot(dashpot->share * held);
    if (given(dashpot->name) && given("restitution")) {
      if (std::fabs(now - m.restitution) > kSameRestitution) {
        throw std::invalid_argument(fmt::format(
            "material.restitution: found {:g} with material.{} = {:g}, which leaves {:.4g}; leave "
            "one of them out, and it follows from the other",
            m.restitution, dashpot->name, held, now));
      }
    } else if (given("restitution") || (by_rate && !given(dashpot->name))) {
      held = dashpot_of_restitution(m.restitution) / dashpot->share;
    } else {
      m.restitution = std::max(std::round(now * kShown) / kShown, kLeastRestitution);
    }
  }
  if (!given("tangential_damping")) m.tangential_damping = 0.5 * m.normal_damping;
}

const char* followed_by(std::string_view member) {
  if (member == "tangential_stiffness") return "2/7 of normal_stiffness";
  if (member == "normal_damping") return "from restitution";
  if (member == "tangential_damping") return "half of normal_damping";
  return "";
}

}  // namespace grainfield::dem
