#include "dem/run/softness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dem/laws/material_setup.h"

namespace grainfield::dem {
namespace {

// Deepest overlap with a floor, radii.
constexpr double kDeepest = 0.5;

}  // namespace

void check_stiff_enough(const MaterialSetup& m, const Burden& b) {
  const bool hertz = m.law == "hertz" || m.law == "hertz_elliptic";
  if (!hertz && m.law != "linear" && m.law != "penalty") return;
  const double mass = m.density * 4 / 3 * std::numbers::pi * std::pow(b.radius, 3);
  const double energy = 0.5 * mass * b.speed * b.speed;
  const double weight = m.density * m.gravity * b.height * 4 * b.radius * b.radius;
  const double depth = kDeepest * b.radius;
  // Hertz: 8/15 E* sqrt(R) d^(5/2) = energy, 4/3 E* sqrt(R) d^(3/2) = weight.
  const double root = std::sqrt(b.radius);
  const double young = 2 * (1 - m.poisson * m.poisson) *
                       std::max(15.0 / 8 * energy / (root * std::pow(depth, 2.5)),
                                0.75 * weight / (root * std::pow(depth, 1.5)));
  const double spring = std::max(2 * energy / (depth * depth), weight / depth);
  const double found = hertz ? m.young : m.normal_stiffness, least = hertz ? young : spring;
  if (found >= least) return;
  throw std::invalid_argument(fmt::format(
      "material.{}: found {:g} {}, allowed: at least {:.2g} for grains with a radius of "
      "{:g} m that meet at {:.2g} m/s and lie {:.2g} m high (softer ones sink through the floor; "
      "stiffer ones need "
      "shorter steps, as its square root)",
      hertz ? "young" : "normal_stiffness", found, hertz ? "Pa" : "N/m", least, b.radius, b.speed,
      b.height));
}

}  // namespace grainfield::dem
