// Random packings and imposed motions for the tests of strain.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <numbers>

#include "dem/random/random.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::test {

/// A jittered lattice of columns x rows (x rows in 3D) grains one unit d apart, radii uniform in
/// d (0.35 .. 0.65), some grains missing, contacts between all pairs nearer than 1.45 d with the
/// contact point anywhere near the middle and off the line of centres, as between polygons.
inline dem::Snapshot random_packing(std::uint64_t seed, int columns, int rows, int dim = 2,
                                    double jitter = 0.2, double d = 0.01) {
  dem::Random random(seed);
  dem::Snapshot s;
  s.dim = dim;
  for (int z = 0; z < (dim == 3 ? rows : 1); ++z)
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        dem::Grain g;
        g.id = x + 1000 * y + 1000000 * z;
        const auto place = [&](int k) { return d * (k + 0.5 + jitter * random.uniform(-1, 1)); };
        g.position = {place(x), place(y), dim == 3 ? place(z) : 0};
        g.radius = d * random.uniform(0.35, 0.65);
        g.volume = std::numbers::pi * g.radius * g.radius;
        g.mass = 5000 * g.volume;
        g.inertia = g.mass * g.radius * g.radius / 2;
        g.angle = random.uniform(-3, 3);
        if (random.uniform() > 0.05 || jitter == 0) s.grains.push_back(g);
      }
  for (std::size_t i = 0; i < s.grains.size(); ++i)
    for (std::size_t j = i + 1; j < s.grains.size(); ++j) {
      const dem::Vec3 branch = s.grains[j].position - s.grains[i].position;
      if (branch.norm() > 1.45 * d) continue;
      dem::Contact c;
      c.i = static_cast<std::int64_t>(i);
      c.j = static_cast<std::int64_t>(j);
      c.point = s.grains[i].position + random.uniform(0.4, 0.6) * branch;
      for (int k = 0; k < dim; ++k) c.point[k] += 0.1 * d * random.uniform(-1, 1);
      c.normal = branch.normalized();
      s.contacts.push_back(c);
    }
  return s;
}

/// The same grains, each displaced by u(its position) and turned by `turn`.
inline dem::Snapshot moved(dem::Snapshot s, const std::function<dem::Vec3(const dem::Vec3&)>& u,
                           double turn = 0) {
  for (dem::Grain& g : s.grains) {
    g.position += u(g.position);
    g.angle += turn;
  }
  return s;
}

}  // namespace grainfield::test
