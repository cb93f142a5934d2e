// The neighbour search against all pairs.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "dem/neighbours/hierarchical_grid.h"
#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

std::vector<std::pair<int, int>> all_pairs(const std::vector<Body>& bodies, double skin) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(bodies.size()); ++j) {
      const Body &a = bodies[i], &b = bodies[j];
      if (a.inverse_mass == 0 && b.inverse_mass == 0) continue;
      const double dx = b.x - a.x, dy = b.y - a.y, sum = a.radius + b.radius + skin;
      if (dx * dx + dy * dy < sum * sum) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

TEST(Neighbours, FindsExactlyThePairsOfAllSizes) {
  for (const double ratio : {1.0, 3.0, 20.0, 100.0}) {
    for (int seed = 0; seed < 20; ++seed) {
      Random random(seed);
      std::vector<Body> bodies(200);
      for (Body& b : bodies) {
        b.radius = 0.01 * std::pow(ratio, random.uniform());
        b.x = random.uniform(-1, 1) * (seed % 3 == 0 ? 30 : 1);  // dense, and thinly spread
        b.y = random.uniform(-0.2, 0.2);
        b.inverse_mass = random.uniform() < 0.1 ? 0 : 1;
      }
      bodies[1].x = bodies[0].x;  // same place
      bodies[1].y = bodies[0].y;
      const double skin = seed % 2 == 0 ? 0 : 0.005;
      HierarchicalGrid grid;
      grid.build(bodies, skin);
      std::vector<std::pair<int, int>> found;
      grid.pairs(bodies, found);
      EXPECT_EQ(found, all_pairs(bodies, skin)) << "ratio " << ratio << " seed " << seed;
      auto order = grid.order(bodies);
      std::sort(order.begin(), order.end());
      for (int i = 0; i < 200; ++i) ASSERT_EQ(order[i], i);
    }
  }
}

TEST(Neighbours, EmptyAndSingle) {
  HierarchicalGrid grid;
  std::vector<Body> bodies;
  std::vector<std::pair<int, int>> found{{1, 2}};
  grid.build(bodies, 0.1);
  grid.pairs(bodies, found);
  EXPECT_TRUE(found.empty());
  bodies.resize(1);
  bodies[0].radius = 1;
  grid.build(bodies, 0.1);
  grid.pairs(bodies, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace grainfield::dem
