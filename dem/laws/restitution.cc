#include "dem/laws/restitution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include "dem/laws/registry.h"
#include "dem/space/space3.h"

namespace grainfield::dem {
namespace {

// Steps while the deepest overlap would be crossed at the speed of the impact, and of one contact
// in all; grains that have not parted by then keep next to nothing of their speed.
constexpr double kStepsOfDepth = 1000;
constexpr int kMostSteps = 400'000;
// Shares between which dashpot_of_restitution() looks: at the upper one 1e-6 of the speed is left.
constexpr double kMostShare = 1e3;

// Two equal disks: the lens of their overlap.
Overlap overlap_of(const RoundGrain& g, double depth, bool fixed_length) {
  Overlap o;
  const double half = std::acos(std::max(0.0, 1 - depth / (2 * g.radius)));
  o.nx = 1;
  o.depth = depth;
  o.area = g.radius * g.radius * (2 * half - std::sin(2 * half));
  o.chord = 2 * g.radius * std::sin(half);
  o.arm_i = o.arm_j = o.lever_i = o.lever_j = g.radius - 0.5 * depth;
  o.length = 0.5 * (fixed_length ? g.radius : o.arm_i);
  return o;
}

Overlap3 overlap_of(const RoundGrain& g, double depth) {
  Overlap3 o;
  o.normal = {1, 0, 0};
  o.depth = depth;
  o.arm_i = {g.radius - 0.5 * depth, 0, 0};
  o.arm_j = -o.arm_i;
  o.major = {0, 1, 0};
  o.radius = 0.5 * g.radius;
  o.lesser_curvature = o.greater_curvature = 1 / g.radius;
  return o;
}

template <int D, class Law>
double restitution_under(const Law& law, const RoundGrain& g, double mass, double speed) {
  const auto overlap = [&](double depth) {
    if constexpr (D == 2) {
      return overlap_of(g, depth, Law::measures == Measures::gradient);
    } else {
      return overlap_of(g, depth);
    }
  };
  ContactMotion<D> motion;
  motion.inverse_mass = 1 / mass + 1 / mass;
  motion.inverse_inertia_i = motion.inverse_inertia_j =
      1 / ((D == 2 ? 0.5 : 0.4) * mass * g.radius * g.radius);
  const auto force = [&](double depth, double approach) {
    if (!(depth > 0)) depth = 0;
    motion.approach = approach;
    typename Law::template Memory<D> memory;
    return law(overlap(depth), motion, 0, 0, memory).normal;
  };
  // The depth at which the spring alone would stop them.
  const double kinetic = 0.25 * mass * speed * speed;
  const typename Law::template Memory<D> none;
  double least = 0, most = g.radius;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (least + most);
    (law.energy(overlap(middle), none).normal < kinetic ? least : most) = middle;
  }
  double dt = most / speed / kStepsOfDepth;
  if (const double rate = law.viscous_rate(mass, g.radius); rate > 0) {
    dt = std::min(dt, 0.5 / rate);
  }
  const double inverse = 2 / mass;  // of the reduced mass
  double d = 0, v = speed;
  for (int k = 0; k < kMostSteps; ++k) {
    const double a1 = -inverse * force(d, v);
    const double v2 = v + 0.5 * dt * a1, a2 = -inverse * force(d + 0.5 * dt * v, v2);
    const double v3 = v + 0.5 * dt * a2, a3 = -inverse * force(d + 0.5 * dt * v2, v3);
    const double v4 = v + dt * a3, a4 = -inverse * force(d + dt * v3, v4);
    d += dt / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    if (v < 0 && (!(d > 0) || force(d, v) == 0)) return -v / speed;
  }
  return 0;
}

}  // namespace

double time_of_dashpot(double share) {
  const double rest = 1 - share * share;
  if (rest > 0) {
    const double w = std::sqrt(rest);
    return (std::numbers::pi - std::atan2(2 * share * w, w * w - share * share)) / w;
  }
  const double w = std::sqrt(-rest);
  return w > 0 ? std::log((share + w) / (share - w)) / w : 2;
}

double restitution_of_dashpot(double share) { return std::exp(-share * time_of_dashpot(share)); }

double dashpot_of_restitution(double restitution) {
  if (!(restitution > 0 && restitution <= 1)) {
    throw std::invalid_argument(
        fmt::format("found a restitution of {:g}, allowed: above 0, up to 1", restitution));
  }
  double least = 0, most = kMostShare;
  while (true) {
    const double middle = 0.5 * (least + most);
    if (!(least < middle && middle < most)) return least;
    (restitution_of_dashpot(middle) > restitution ? least : most) = middle;
  }
}

double mass_of(const RoundGrain& g, double density) {
  const double pi = std::numbers::pi, r = g.radius;
  return density * (g.dim == 3 ? 4.0 / 3 * pi * r * r * r : pi * r * r);
}

double head_on_restitution(const MaterialSetup& material, const RoundGrain& grain, double speed) {
  const double mass = mass_of(grain, material.density);
  return std::visit(
      [&]<class Law>(const Law& law) -> double {
        if constexpr (ContactLaw<Law, 2>) {
          if (grain.dim == 2) return restitution_under<2>(law, grain, mass, speed);
        }
        if constexpr (ContactLaw<Law, 3>) {
          if (grain.dim == 3) return restitution_under<3>(law, grain, mass, speed);
        }
        throw std::invalid_argument(
            fmt::format("material.law: found {} with grains of {}D", Law::name, grain.dim));
      },
      law_of(material));
}

double stiffness_ratio(const MaterialSetup& m) {
  if (m.law == "linear" || m.law == "penalty") return m.tangential_stiffness / m.normal_stiffness;
  if (m.law == "hertz" || m.law == "hertz_elliptic") return 2 * (1 - m.poisson) / (2 - m.poisson);
  return m.tangential_ratio;
}

}  // namespace grainfield::dem
