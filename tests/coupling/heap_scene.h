// Heaps with known forces for the tests of piles.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "dem/random/random.h"
#include "dem/run/run.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::test {

/// Regular polygon with its corners on a circle of radius r.
inline dem::Outline regular_outline(int corners, double r) {
  dem::Outline out;
  for (int k = 0; k < corners; ++k) {
    const double a = 2 * std::numbers::pi * k / corners;
    out.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return out;
}

/// Heptagons of diameter d on a triangular lattice, `rows` in the lowest row, one on top, in
/// equilibrium on a floor at y = 0 (Liffman 1992): a row of j grains carries the weight of all rows
/// above equally on each grain, (j + 1) m g / 2. In the continuum limit the vertical pressure is
/// half of rho g times the depth, the same at every abscissa of a cut.
inline dem::Snapshot lattice_heap(int rows, double d = 0.005, double gravity = 9.81,
                                  double apex_x = 0) {
  dem::Snapshot s;
  s.gravity = {0, -gravity, 0};
  for (const auto& [name, x, normal] : {std::tuple{"floor", 0.0, dem::Vec3(0, 1, 0)},
                                        std::tuple{"left", -rows * d, dem::Vec3(1, 0, 0)},
                                        std::tuple{"right", rows * d, dem::Vec3(-1, 0, 0)}}) {
    dem::Wall wall;
    wall.name = name;
    wall.point = {apex_x + x, 0, 0};
    wall.normal = normal;
    wall.friction = 1;
    s.walls.push_back(wall);
  }
  const double lift = d * std::sqrt(3) / 2;
  const dem::Outline outline = regular_outline(7, d / 2);
  const double area = 7 * d * d / 8 * std::sin(2 * std::numbers::pi / 7);
  // Rows from the floor up, so that ids grow in the order of dropping.
  std::vector<std::vector<std::int64_t>> index(static_cast<std::size_t>(rows) + 1);
  for (int j = rows; j >= 1; --j) {
    for (int i = 0; i < j; ++i) {
      dem::Grain g;
      g.id = static_cast<std::int64_t>(s.grains.size());
      g.position = {apex_x + (i - (j - 1) / 2.0) * d, d / 2 + (rows - j) * lift, 0};
      g.angle = 0.7 * i + j;
      g.radius = d / 2;
      g.volume = area;
      g.mass = 5000 * area;
      g.inertia = g.mass * d * d / 9;
      g.outline = outline;
      index[static_cast<std::size_t>(j)].push_back(g.id);
      s.grains.push_back(g);
    }
  }
  const double half = 5000 * area * gravity / 2, cot = 1 / std::sqrt(3);
  const auto touch = [&](std::int64_t i, std::int64_t j, dem::Vec3 point, dem::Vec3 force) {
    dem::Contact c;
    c.i = i;
    c.j = j;
    c.point = point;
    const dem::Vec3& from = s.grains[static_cast<std::size_t>(i)].position;
    c.normal = (point - from).normalized();
    c.force = force;
    c.normal_force = -force.dot(c.normal);
    c.tangential_force = force.dot(dem::Vec3(-c.normal.y(), c.normal.x(), 0));
    c.friction = 1;
    s.contacts.push_back(c);
  };
  for (int j = rows; j >= 1; --j) {
    for (int i = 0; i < j; ++i) {
      const std::int64_t own = index[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
      const dem::Vec3 at = s.grains[static_cast<std::size_t>(own)].position;
      // Vertical parts of the forces down to the left and to the right.
      const double left = (j - i) * half, right = (i + 1) * half;
      if (j == rows) {
        touch(own, -1, {at.x(), 0, 0}, {(left - right) * cot, left + right, 0});
        continue;
      }
      const auto& below = index[static_cast<std::size_t>(j) + 1];
      for (const auto& [other, force, side] :
           {std::tuple{below[static_cast<std::size_t>(i)], left, 1.0},
            std::tuple{below[static_cast<std::size_t>(i) + 1], right, -1.0}}) {
        const dem::Vec3 there = s.grains[static_cast<std::size_t>(other)].position;
        // On the lower grain, which has the smaller index.
        touch(other, own, (at + there) / 2, {-side * force * cot, -force, 0});
      }
    }
  }
  std::sort(s.contacts.begin(), s.contacts.end(),
            [](const auto& a, const auto& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  return s;
}

/// Multiplies the floor's forces by 1 - depth exp(-(x/width)^2) and by noise of this relative size,
/// and rescales them to the same sum. (The grains above then no longer balance.)
inline void plant_dip(dem::Snapshot& s, double depth, double width, double noise,
                      std::uint64_t seed) {
  dem::Random random(seed);
  double before = 0, after = 0;
  for (int round = 0; round < 2; ++round) {
    for (dem::Contact& c : s.contacts) {
      if (c.j >= 0) continue;
      if (round == 1) {
        c.force *= before / after;
        continue;
      }
      before += c.force.y();
      const double x = c.point.x() / width;
      c.force *= (1 - depth * std::exp(-x * x)) * (1 + noise * random.uniform(-1, 1));
      after += c.force.y();
    }
  }
}

inline double heap_weight(const dem::Snapshot& s) {
  double sum = 0;
  for (const dem::Grain& g : s.grains) sum -= g.mass * s.gravity.y();
  return sum;
}

}  // namespace grainfield::test
