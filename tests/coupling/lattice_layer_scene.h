// Layers of equal grains in exact equilibrium under their weight, which repeat sideways.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "dem/snapshot/images.h"

namespace grainfield::test {

inline constexpr double kLatticeDiameter = 0.01, kLatticeWeight = 9.81;

// Rows of equal grains, each in the hollows of the row below, on a floor: in the plane two hollows
// carry a grain, in space four. Grains side by side do not touch, so every contact between rows
// carries its share of the weight above, and all grains are in equilibrium.
inline dem::Snapshot lattice_layer(int dim, int columns, int rows) {
  const double gap = 1.02 * kLatticeDiameter;  // between centres in a row
  const double across = (dim == 2 ? 0.5 : std::sqrt(0.5)) * gap;
  const double rise = std::sqrt(kLatticeDiameter * kLatticeDiameter - across * across);
  const int up = dim - 1;
  dem::Snapshot s;
  s.dim = dim;
  s.gravity = -9.81 * dem::Vec3::Unit(up);
  s.cell.low = dem::Vec3(0.0031, dim == 3 ? -0.0017 : 0, 0);  // cuts through grains
  for (int a = 0; a < up; ++a) {
    s.cell.periodic[static_cast<std::size_t>(a)] = true;
    s.cell.edges(a, a) = columns * gap;
  }
  const int lines = dim == 2 ? 1 : columns, per_row = columns * lines;
  const double mass = kLatticeWeight / 9.81;
  const auto id = [&](int x, int y, int row) {
    return (x % columns + columns) % columns + columns * ((y % lines + lines) % lines) +
           per_row * row;
  };
  for (int row = 0; row < rows; ++row)
    for (int y = 0; y < lines; ++y)
      for (int x = 0; x < columns; ++x) {
        dem::Grain g;
        g.id = id(x, y, row);
        const double shift = row % 2 == 0 ? 0.25 : 0.75;
        g.position.x() = s.cell.low.x() + (x + shift) * gap;
        if (dim == 3) g.position.y() = s.cell.low.y() + (y + shift) * gap;
        g.position[up] = 0.5 * kLatticeDiameter + row * rise;
        g.radius = 0.5 * kLatticeDiameter;
        g.volume = std::numbers::pi * g.radius * g.radius * (dim == 2 ? 1 : 4.0 / 3 * g.radius);
        g.mass = mass;
        g.inertia = (dim == 2 ? 0.5 : 0.4) * mass * g.radius * g.radius;
        g.moments.setConstant(g.inertia);
        s.grains.push_back(g);
      }
  dem::Wall floor;
  floor.name = "floor";
  floor.normal = dem::Vec3::Unit(up);
  s.walls.push_back(floor);
  const auto grain = [&](int k) -> const dem::Grain& {
    return s.grains[static_cast<std::size_t>(k)];
  };
  for (int row = 0; row < rows; ++row)
    for (int y = 0; y < lines; ++y)
      for (int x = 0; x < columns; ++x) {
        const int above = id(x, y, row);
        const double carried = (rows - row) * kLatticeWeight;
        if (row == 0) {
          dem::Contact c;
          c.i = above;
          c.j = -1;
          c.point = grain(above).position;
          c.point[up] = 0;
          c.normal = -dem::Vec3::Unit(up);
          c.normal_force = carried;
          c.force = carried * dem::Vec3::Unit(up);
          s.contacts.push_back(c);
          continue;
        }
        const int back = row % 2 == 0 ? -1 : 0;  // the hollow on the left, of even rows
        for (int dy = 0; dy < (dim == 2 ? 1 : 2); ++dy)
          for (int dx = 0; dx < 2; ++dx) {
            const int below = id(x + back + dx, dim == 2 ? 0 : y + back + dy, row - 1);
            dem::Contact c;
            c.i = below;
            c.j = above;
            c.image = dem::nearest_image(s.cell, grain(above).position - grain(below).position);
            const dem::Vec3 branch = dem::second_place(s, c) - grain(below).position;
            EXPECT_NEAR(branch.norm(), kLatticeDiameter, 1e-12);
            c.normal = branch.normalized();
            c.point = grain(below).position + 0.5 * branch;
            c.normal_force = carried / (dim == 2 ? 2 : 4) / c.normal[up];
            c.force = -c.normal_force * c.normal;
            s.contacts.push_back(c);
          }
      }
  std::sort(s.contacts.begin(), s.contacts.end(),
            [](const auto& a, const auto& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  return s;
}

}  // namespace grainfield::test
