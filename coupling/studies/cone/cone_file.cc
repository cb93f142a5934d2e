#include "coupling/studies/cone/cone_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "dem/laws/material_setup.h"
#include "dem/quasistatic/sphere_law.h"

namespace grainfield::dem {
namespace {

// Numbers of a file and of a case that agree to this are the same.
constexpr double kSameNumber = 1e-6;
// Forces of contacts at rest are the law's but for what the dashpots still do.
constexpr double kSameForce = 0.02;

void require_same_word(const Snapshot& cone, const char* attribute, const char* key,
                       const std::string& asked, const std::string& where) {
  const auto at = cone.attributes.find(attribute);
  if (at == cone.attributes.end() || at->second == asked) return;
  throw std::invalid_argument(
      fmt::format("{}: found \"{}\", the cone {} has \"{}\"", key, asked, where, at->second));
}

void require_same_number(const char* key, double asked, double found, const std::string& where) {
  if (std::fabs(asked - found) <= kSameNumber * std::max(std::fabs(asked), std::fabs(found)))
    return;
  throw std::invalid_argument(
      fmt::format("{}: found {:g}, the cone {} has {:g}", key, asked, where, found));
}

// Median of the contacts' normal forces over the law's at their depth; none without such contacts,
// or with a law that does not tell.
std::optional<double> force_ratio(const MaterialSetup& material, const Snapshot& cone) {
  std::optional<SphereLaw> law;
  try {
    law.emplace(law_of(material));
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  std::vector<double> ratios;
  for (const Contact& c : cone.contacts) {
    if (c.j < 0) continue;
    const Grain &a = cone.grains[static_cast<std::size_t>(c.i)],
                &b = cone.grains[static_cast<std::size_t>(c.j)];
    const double depth = a.radius + b.radius - (a.position - b.position).norm();
    if (!(depth > 0)) continue;
    const double force = law->repulsion(depth, a.radius * b.radius / (a.radius + b.radius)).value;
    if (force > 0) ratios.push_back(c.normal_force / force);
  }
  if (ratios.empty()) return std::nullopt;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

}  // namespace

void check_same_cone(const ConeSetup& s, const Snapshot& cone, const std::string& where) {
  require_same_word(cone, "source", "cone.source", s.plan.source, where);
  require_same_word(cone, "shape", "cone.shape", s.plan.shape, where);
  require_same_word(cone, "floor", "cone.floor", s.plan.floor, where);
  require_same_word(cone, "law", "material.law", s.material.law, where);
  require_same_number("material.gravity", s.material.gravity, cone.gravity.norm(), where);
  for (const Grain& g : cone.grains) {
    if (g.fixed || !(g.volume > 0)) continue;
    require_same_number("material.density", s.material.density, g.mass / g.volume, where);
    break;
  }
  for (const Contact& c : cone.contacts) {
    if (c.j < 0) continue;
    require_same_number("material.friction", s.material.friction, c.friction, where);
    break;
  }
  if (s.plan.shape != "sphere") return;
  const std::optional<double> ratio = force_ratio(s.material, cone);
  if (!ratio || std::fabs(*ratio - 1) <= kSameForce) return;
  const bool hertz = s.material.law == "hertz";
  throw std::invalid_argument(fmt::format(
      "material.{}: found {:g}, the forces in the cone {} are {:.4g} times as large as this "
      "stiffness gives at the depths of its contacts",
      hertz ? "young" : "normal_stiffness", hertz ? s.material.young : s.material.normal_stiffness,
      where, *ratio));
}

}  // namespace grainfield::dem
