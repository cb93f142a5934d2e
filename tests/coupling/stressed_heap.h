// A heap of disks on a triangular lattice whose contact forces carry a given stress field: each
// contact has the force sigma n d/sqrt(3), sigma taken at the contact and n along the bond, which
// gives every grain that stress (sum over three bonds of n n = 3/2) and, for a field in
// equilibrium that is linear in x and y, balances its weight.
#pragma once
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include "dem/random/random.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::test {

struct StressedHeap {
  double left_deg = 28, right_deg = 28;  ///< slopes
  double diameter = 0.01;                ///< m
  int rows = 35;                         ///< height: diameter + (rows - 1) sqrt(3)/2 diameter
  double floor = 0, apex_x = 0;          ///< m
  double noise = 0;                      ///< contact forces: relative, uniform
  std::uint64_t seed = 1;
};

/// Weight per area of the lattice, N/m2: density 5000 kg/m2 at pi/(2 sqrt 3).
inline double lattice_rho_g() { return 5000 * 9.81 * std::numbers::pi / (2 * std::sqrt(3.0)); }

/// `stress`: xx, yy, xy at a point seen from the apex (y up), tension positive; nan: none.
inline dem::Snapshot stressed_heap(const StressedHeap& setup,
                                   const std::function<Eigen::Vector3d(double, double)>& stress) {
  const double d = setup.diameter, lift = d * std::sqrt(3.0) / 2, h = d + (setup.rows - 1) * lift;
  const double left = std::tan(setup.left_deg * std::numbers::pi / 180);
  const double right = std::tan(setup.right_deg * std::numbers::pi / 180);
  dem::Random random(setup.seed);
  dem::Snapshot s;
  s.gravity = {0, -9.81, 0};
  dem::Wall wall;
  wall.name = "floor";
  wall.point = {0, setup.floor, 0};
  wall.normal = {0, 1, 0};
  wall.friction = 0.5;
  s.walls.push_back(wall);
  std::map<std::pair<int, int>, std::int64_t> at;  // row, column in half diameters
  for (int row = 0; row < setup.rows; ++row) {
    const double y = d / 2 + row * lift - h;  // from the apex
    const int reach = static_cast<int>(2 * h / std::min(left, right) / d) + 2;
    for (int column = -reach; column <= reach; ++column) {
      if ((column + row) % 2 != 0) continue;
      const double x = column * d / 2;
      // The surface's steps lie about the slope's line, but for the apex.
      const double over = std::fabs(x) < d ? 1e-9 : 0.4 * lift;
      if (y + d / 2 - over > (x < 0 ? left : -right) * x) continue;
      dem::Grain g;
      g.id = static_cast<std::int64_t>(s.grains.size());
      g.position = {setup.apex_x + x, setup.floor + h + y, 0};
      g.radius = d / 2;
      g.volume = std::numbers::pi * d * d / 4;
      g.mass = 5000 * g.volume;
      g.inertia = g.mass * d * d / 8;
      at[{row, column}] = g.id;
      s.grains.push_back(g);
    }
  }
  const auto force_at = [&](double x, double y, const Eigen::Vector2d& n) {
    const Eigen::Vector3d t = stress(x, y);
    Eigen::Vector2d f(t[0] * n.x() + t[2] * n.y(), t[2] * n.x() + t[1] * n.y());
    f *= d / std::sqrt(3.0) * (1 + setup.noise * random.uniform(-1, 1));
    return dem::Vec3(f.x(), f.y(), 0);
  };
  const auto add = [&](std::int64_t i, std::int64_t j, const dem::Vec3& point,
                       const dem::Vec3& normal, const dem::Vec3& force) {
    dem::Contact c;
    c.i = i;
    c.j = j;
    c.point = point;
    c.normal = normal;
    c.force = force;
    c.normal_force = -force.dot(normal);
    c.tangential_force = force.dot(dem::Vec3(-normal.y(), normal.x(), 0));
    c.friction = 0.5;
    c.sliding = std::fabs(c.tangential_force) > c.friction * c.normal_force;
    s.contacts.push_back(c);
  };
  const double half = std::sqrt(3.0) / 2;
  for (const auto& [place, i] : at) {
    const auto& [row, column] = place;
    const dem::Vec3 own = s.grains[static_cast<std::size_t>(i)].position;
    const double x = own.x() - setup.apex_x, y = own.y() - setup.floor - h;
    // To the right, and up to either side: every pair once, from the grain of smaller index.
    for (const auto& [up, aside, n] :
         {std::tuple{0, 2, Eigen::Vector2d(1, 0)}, std::tuple{1, 1, Eigen::Vector2d(0.5, half)},
          std::tuple{1, -1, Eigen::Vector2d(-0.5, half)}}) {
      const auto other = at.find({row + up, column + aside});
      if (other == at.end()) continue;
      const Eigen::Vector2d mid = Eigen::Vector2d(x, y) + d / 2 * n;
      const dem::Vec3 force = force_at(mid.x(), mid.y(), n);
      if (!force.allFinite()) continue;
      add(i, other->second, own + dem::Vec3(d / 2 * n.x(), d / 2 * n.y(), 0), {n.x(), n.y(), 0},
          force);
    }
    if (row != 0) continue;
    // The floor pushes as the two bonds below would.
    dem::Vec3 push = dem::Vec3::Zero();
    for (const double side : {-0.5, 0.5}) {
      const Eigen::Vector2d n(side, -half);
      const dem::Vec3 force = force_at(x, y - d / 2, n);
      if (force.allFinite()) push += force;
    }
    if (push.y() > 0) add(i, -1, {own.x(), setup.floor, 0}, {0, -1, 0}, push);
  }
  return s;
}

}  // namespace grainfield::test
