// Packings in periodic cells with made-up forces.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dem/random/random.h"
#include "dem/snapshot/images.h"

namespace grainfield::test {

/// A disturbed lattice of disks or spheres in a tilted cell, contacts of all neighbours with random
/// forces. Along the last axis it is periodic only if told so.
inline dem::Snapshot periodic_packing(int dim, unsigned seed, bool last_axis = true) {
  dem::Random random(seed);
  const int n = dim == 2 ? 8 : 5;
  const double spacing = 0.01;
  dem::Snapshot s;
  s.dim = dim;
  s.gravity = {0, 0, 0};
  s.cell.low = {0.02, -0.01, dim == 2 ? 0 : 0.005};
  for (int a = 0; a < dim; ++a) {
    s.cell.periodic[static_cast<std::size_t>(a)] = a + 1 < dim || last_axis;
    s.cell.edges(a, a) = n * spacing;
  }
  s.cell.edges(0, 1) = 0.3 * n * spacing;
  if (dim == 3 && last_axis) s.cell.edges(1, 2) = -0.2 * n * spacing;
  const int count = dim == 2 ? n * n : n * n * n;
  for (int k = 0; k < count; ++k) {
    dem::Grain g;
    g.id = k;
    dem::Vec3 share = dem::Vec3::Zero();
    const int at[] = {k % n, k / n % n, k / (n * n)};
    for (int a = 0; a < dim; ++a) share[a] = (at[a] + 0.4 + 0.2 * random.uniform()) / n;
    g.position = s.cell.low + s.cell.edges * share;
    g.radius = spacing * (0.5 + 0.1 * random.uniform());
    g.volume = std::numbers::pi * g.radius * g.radius * (dim == 2 ? 1 : 4.0 / 3 * g.radius);
    g.mass = 2500 * g.volume;
    g.inertia = (dim == 2 ? 0.5 : 0.4) * g.mass * g.radius * g.radius;
    g.velocity = {random.uniform(), random.uniform(), dim == 2 ? 0 : random.uniform()};
    if (dim == 3) g.moments.setConstant(g.inertia);
    s.grains.push_back(g);
  }
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j) {
      const dem::Grain &a = s.grains[static_cast<std::size_t>(i)],
                       &b = s.grains[static_cast<std::size_t>(j)];
      dem::Contact c;
      c.i = i;
      c.j = j;
      c.image = dem::nearest_image(s.cell, b.position - a.position);
      const dem::Vec3 branch = dem::second_place(s, c) - a.position;
      if (branch.norm() > a.radius + b.radius) continue;
      const double d = branch.norm();
      c.normal = branch / d;
      c.point =
          a.position + (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d) * c.normal;
      c.normal_force = 1 + random.uniform();
      dem::Vec3 across(random.uniform(), random.uniform(), dim == 2 ? 0 : random.uniform());
      across = 0.3 * (across - across.dot(c.normal) * c.normal);
      c.force = across - c.normal_force * c.normal;
      c.tangential_force =
          dim == 2 ? across.dot(dem::Vec3(-c.normal.y(), c.normal.x(), 0)) : across.norm();
      c.spring = c.friction = std::nan("");
      if (dim == 3) {
        c.spring_vector = across;
        c.spring = across.norm();
      }
      s.contacts.push_back(c);
    }
  return s;
}

/// The same packing seen elsewhere: all moved and taken back into the cell.
inline dem::Snapshot moved(dem::Snapshot s, const dem::Vec3& by) {
  for (dem::Contact& c : s.contacts) {
    const dem::Vec3 first = s.grains[static_cast<std::size_t>(c.i)].position,
                    second = dem::second_place(s, c);
    const dem::Vec3 a = dem::wrapped(s.cell, first + by),
                    b = dem::wrapped(s.cell, s.grains[static_cast<std::size_t>(c.j)].position + by);
    c.image = dem::nearest_image(s.cell, b - a);
    c.point += a - first;
    EXPECT_LT((b + dem::shift_to(s.cell, c.image) - a - (second - first)).norm(), 1e-12);
  }
  for (dem::Grain& g : s.grains) g.position = dem::wrapped(s.cell, g.position + by);
  return s;
}

/// Sum over contacts of force (outer) branch, N m.
inline Eigen::Matrix3d sum_of_branches(const dem::Snapshot& s) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const dem::Contact& c : s.contacts)
    sum += c.force *
           (dem::second_place(s, c) - s.grains[static_cast<std::size_t>(c.i)].position).transpose();
  return sum;
}

inline int contacts_across(const dem::Snapshot& s) {
  int count = 0;
  for (const dem::Contact& c : s.contacts) count += c.image != std::array<int, 3>{0, 0, 0};
  return count;
}

}  // namespace grainfield::test
