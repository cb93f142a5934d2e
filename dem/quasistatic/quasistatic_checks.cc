#include "dem/quasistatic/quasistatic_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace grainfield::dem {
namespace {

// A strain beyond this is not small: contact normals turn.
constexpr double kMostStrain = 0.01;

}  // namespace

void check_settings(const QuasistaticSettings& s) {
  const auto refuse = [](const char* key, double found, const char* allowed) {
    throw std::invalid_argument(
        fmt::format("quasi-static {}: found {:g}, allowed: {}", key, found, allowed));
  };
  if (!(s.unbalanced_force_ratio >= 1e-12 && s.unbalanced_force_ratio <= 0.1)) {
    refuse("unbalanced_force_ratio", s.unbalanced_force_ratio, "1e-12 to 0.1");
  }
  if (s.max_iterations < 1) refuse("max_iterations", s.max_iterations, "1 or more");
  if (s.first_steps < 1) refuse("first_steps", s.first_steps, "1 or more");
  if (!(s.least_step > 0 && s.least_step <= 1)) {
    refuse("least_step", s.least_step, "above 0, at most 1");
  }
}

void check_start(const Snapshot& s) {
  if (s.dim == 2 && s.cell.is_periodic()) {
    throw std::invalid_argument(
        "quasi-static relaxation: found a periodic cell in the plane, allowed: packings between "
        "walls");
  }
  if (!s.cell.velocity_gradient.isZero(0)) {
    throw std::invalid_argument(
        "quasi-static relaxation: found a cell that flows, allowed: one at rest");
  }
  const auto n = static_cast<std::int64_t>(s.grains.size());
  const auto walls = static_cast<std::int64_t>(s.walls.size());
  for (const Wall& wall : s.walls) {
    if (!wall.velocity.isZero(0) || !wall.angular_velocity.isZero(0) || !wall.material.empty()) {
      throw std::invalid_argument(
          fmt::format("quasi-static relaxation: wall {}: found one that moves or has a material, "
                      "allowed: at rest, with a friction of its own",
                      wall.name));
    }
    if (wall.shape == "plane") continue;
    throw std::invalid_argument(
        fmt::format("quasi-static relaxation: wall {}: shape: found \"{}\", allowed: plane",
                    wall.name, wall.shape));
  }
  bool any_free = false;
  for (const Grain& g : s.grains) {
    any_free |= !g.fixed;
    if (!g.fixed && !g.rotates) {
      throw std::invalid_argument(fmt::format(
          "quasi-static relaxation: found that grain {} does not turn, allowed: grains that do",
          g.id));
    }
    if (g.axes.isZero(0) != s.grains.front().axes.isZero(0)) {
      throw std::invalid_argument(
          fmt::format("quasi-static relaxation: found that of the grains {} and {} one is a "
                      "superellipsoid, allowed: all or none",
                      s.grains.front().id, g.id));
    }
    if (!(g.position.allFinite() && std::isfinite(g.angle) && g.radius > 0 &&
          (g.fixed || (g.mass > 0 && std::isfinite(g.mass))))) {
      throw std::invalid_argument(fmt::format(
          "quasi-static relaxation: grain {} has a position, radius or mass that cannot be: "
          "({:g}, {:g}) m, {:g} m, {:g} kg",
          g.id, g.position.x(), g.position.y(), g.radius, g.mass));
    }
  }
  if (!any_free) {
    throw std::invalid_argument("quasi-static relaxation: found no grain that is free to move");
  }
  for (const Contact& c : s.contacts) {
    if (c.i < 0 || c.i >= n || c.j >= n || c.j < -walls || c.i == c.j || !std::isfinite(c.spring) ||
        !c.rolling_spring.allFinite() || !std::isfinite(c.twisting_spring)) {
      throw std::invalid_argument(
          fmt::format("quasi-static relaxation: found a contact of {} with {}, allowed: {} grains "
                      "and {} walls",
                      c.i, c.j, n, walls));
    }
  }
}

void check_strained(const Snapshot& start) {
  check_start(start);
  for (const Contact& c : start.contacts) {
    if (c.j >= 0 || start.grains[static_cast<std::size_t>(c.i)].fixed) continue;
    throw std::invalid_argument(fmt::format(
        "quasi-static strain: found that the free grain {} touches wall {}, allowed: free grains "
        "between fixed ones and in cells that repeat",
        start.grains[static_cast<std::size_t>(c.i)].id, start.walls[-1 - c.j].name));
  }
}

void check_gradient(const Eigen::Matrix3d& gradient) {
  if (!gradient.allFinite() || !(gradient.norm() < kMostStrain)) {
    throw std::invalid_argument(
        fmt::format("quasi-static strain: found a gradient of size {:g}, allowed: below {:g}",
                    gradient.norm(), kMostStrain));
  }
}

}  // namespace grainfield::dem
