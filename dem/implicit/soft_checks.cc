#include "dem/implicit/soft_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "dem/neighbours/hierarchical_grid.h"
#include "dem/shared/refuse.h"

namespace grainfield::dem {
namespace {

// Centres of a pair, over the sum of their radii, and of a disk and a wall, over its radius: nearer
// ones could leave to either side.
constexpr double kNearest = 0.5;
constexpr double kUnit = 1e-9;  // how far a normal's length may be from 1

bool not_below_zero(double x) { return x >= 0 && std::isfinite(x); }
bool above_zero(double x) { return x > 0 && std::isfinite(x); }

void check_law(const SoftLaw& law, const std::string& of, bool has_well) {
  require(above_zero(law.stiffness), of + " stiffness", law.stiffness, "above 0");
  for (const auto& [name, value] :
       {std::pair(" damping", law.damping), std::pair(" slip_damping", law.slip_damping),
        std::pair(" rolling_friction", law.rolling_friction), std::pair(" coulomb", law.coulomb),
        std::pair(" tangential_stiffness", law.tangential_stiffness),
        std::pair(" static_friction", law.static_friction)}) {
    require(not_below_zero(value), of + name, value, "0 or more");
  }
  if (law.static_friction > 0) {
    require(has_well, of + " static_friction", law.static_friction, "0: walls alone have wells");
    require(above_zero(law.well), of + " well", law.well, "above 0");
  }
}

void check_settings(const ImplicitSettings& s) {
  require(above_zero(s.time_step), "time_step", s.time_step, "above 0");
  require(s.relaxation > 0 && s.relaxation <= 1, "relaxation", s.relaxation, "above 0, at most 1");
  require(s.tolerance > 0 && s.tolerance < 1, "tolerance", s.tolerance, "above 0, below 1");
  require(s.max_iterations >= 1, "max_iterations", s.max_iterations, "1 or more");
  require(s.most_move > 0 && s.most_move <= 1, "most_move", s.most_move, "above 0, at most 1");
  require(s.most_halvings >= 0 && s.most_halvings <= 30, "most_halvings", s.most_halvings,
          "0 to 30");
}

}  // namespace

void check_soft(const SoftScene& scene, const std::vector<Body<2>>& disks,
                const ImplicitSettings& settings) {
  check_settings(settings);
  check_law(scene.grains, "grains:", false);
  for (std::size_t w = 0; w < scene.walls.size(); ++w) {
    check_law(scene.walls[w].law, fmt::format("wall {}:", w), true);
    const double length = scene.walls[w].normal.norm();
    require(std::fabs(length - 1) <= kUnit, fmt::format("wall {}: length of the normal", w), length,
            "1");
  }
  require(not_below_zero(scene.background_damping), "background_damping", scene.background_damping,
          "0 or more");
  require(scene.gravity.allFinite(), "gravity", scene.gravity.norm(), "finite");

  std::vector<Reach<2>> reaches;
  for (std::size_t k = 0; k < disks.size(); ++k) {
    const Body<2>& b = disks[k];
    require(above_zero(b.radius), fmt::format("disk {}: radius", k), b.radius, "above 0");
    require(b.position.allFinite() && b.velocity.allFinite() && std::isfinite(b.spin),
            fmt::format("disk {}: place or velocity", k), b.position.norm() + b.velocity.norm(),
            "finite");
    for (std::size_t w = 0; w < scene.walls.size(); ++w) {
      const double height = scene.walls[w].normal.dot(b.position - scene.walls[w].point) / b.radius;
      require(height >= kNearest,
              fmt::format("disk {}: height of the centre above wall {} over its radius", k, w),
              height, "0.5 or more, so that Newton's method knows the way out");
    }
    reaches.push_back({b.position, kNearest * b.radius, false});
  }
  HierarchicalGrid<2> grid;
  std::vector<std::pair<int, int>> pairs;
  grid.build(reaches);
  grid.pairs(pairs);
  for (const auto& [i, j] : pairs) {
    const double reach = disks[i].radius + disks[j].radius;
    require(false, fmt::format("disks {} and {}: distance over the sum of their radii", i, j),
            (disks[j].position - disks[i].position).norm() / reach,
            "0.5 or more, so that Newton's method knows the way out");
  }
}

}  // namespace grainfield::dem
