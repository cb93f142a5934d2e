#include "dem/engine/cell_checks.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "dem/shared/computation_failed.h"

namespace grainfield::dem {
namespace {

// Sine of an angle that counts as round-off.
constexpr double kParallel = 1e-9;
constexpr char kAxes[] = {'x', 'y', 'z'};

}  // namespace

void check_wall(const Cell<3>& cell, const Wall& wall, int dim) {
  for (int a = 0; a < 3; ++a) {
    if (!cell.periodic[a]) continue;
    const Vec3 edge = cell.edges.col(a).normalized(), normal = wall.normal.normalized();
    const auto refuse = [&](const char* found, const char* allowed) {
      throw std::invalid_argument(fmt::format(
          "wall \"{}\": found {} in a cell that repeats along ({:.4g}, {:.4g}, {:.4g}) m (axis "
          "{}), allowed: {}",
          wall.name, found, cell.edges(0, a), cell.edges(1, a), cell.edges(2, a), kAxes[a],
          allowed));
    };
    if (wall.shape == "plane") {
      if (std::fabs(edge.dot(normal)) > kParallel) {
        refuse("a plane across that edge", "planes along the periodic edges");
      }
    } else if (dim == 2 && wall.shape == "cylinder") {
      refuse("a circle", "planes along the periodic edges");
    } else if (wall.shape == "cylinder" && wall.length == 0) {
      if (edge.cross(normal).norm() > kParallel) {
        refuse("a cylinder across that edge", "cylinders along the only periodic edge");
      }
    } else {
      refuse(("a " + wall.shape + " that ends").c_str(),
             "planes, and cylinders without ends, along the periodic edges");
    }
  }
}

void check_wall_motion(const Cell<3>& cell, const Wall& wall, const WallMotion& motion) {
  const Vec3& spin = motion.angular_velocity;
  if (!cell.is_periodic() || spin.isZero(0)) return;
  const Vec3 axis = wall.normal.normalized();
  const Vec3 arm = motion.centre ? Vec3(wall.point - *motion.centre) : Vec3(0, 0, 0);
  if (wall.shape == "cylinder" && spin.cross(axis).norm() <= kParallel * spin.norm() &&
      arm.cross(axis).norm() <= kParallel * (wall.radius + arm.norm())) {
    return;
  }
  throw std::invalid_argument(
      fmt::format("wall \"{}\": angular_velocity: found a wall that turns in a periodic cell, "
                  "allowed: cylinders about their own axis",
                  wall.name));
}

void refuse_small_cell(double shortest, double radius) {
  throw std::invalid_argument(fmt::format(
      "cell.edges: found {:.6g} m from a place to its nearest image, allowed for grains of radius "
      "{:.6g} m: at least {:.6g} m ({} radii; else a grain would touch another one, or itself, by "
      "two images)",
      shortest, radius, kLeastCell * radius, kLeastCell));
}

void report_small_cell(double shortest, double radius, double time, long step) {
  throw ComputationFailed(fmt::format(
      "the cell has become too small at t = {:.6g} s (step {}): {:.6g} m from a place to its "
      "nearest image, needed for grains of radius {:.6g} m: {:.6g} m; begin with more grains in a "
      "larger cell, or end cell.velocity_gradient earlier",
      time, step, shortest, radius, kLeastCell * radius));
}

void check_rest_in_flow(bool flows, bool fixed, bool sleeping) {
  if (!flows) return;
  if (fixed) {
    throw std::invalid_argument(
        "cell.velocity_gradient: found a flow with fixed grains, allowed: free grains; the flow "
        "would carry the images of a fixed one away from it");
  }
  if (sleeping) {
    throw std::invalid_argument(
        "cell.velocity_gradient: found a flow with sleeping switched on, allowed: with sleeping "
        "off; nothing rests in a cell that flows");
  }
}

}  // namespace grainfield::dem
