// The neighbour search against all pairs.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "dem/neighbours/hierarchical_grid.h"
#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

std::vector<std::pair<int, int>> all_pairs(const std::vector<Reach<2>>& grains) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < static_cast<int>(grains.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(grains.size()); ++j) {
      const Reach<2>&a = grains[i], &b = grains[j];
      if (a.fixed && b.fixed) continue;
      const double dx = b.centre.x() - a.centre.x(), dy = b.centre.y() - a.centre.y(),
                   sum = a.reach + b.reach;
      if (dx * dx + dy * dy < sum * sum) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

TEST(Neighbours, FindsExactlyThePairsOfAllSizes) {
  for (const double ratio : {1.0, 3.0, 20.0, 100.0}) {
    for (int seed = 0; seed < 20; ++seed) {
      Random random(seed);
      std::vector<Reach<2>> grains(200);
      const double gap = seed % 2 == 0 ? 0 : 0.0025;
      for (Reach<2>& g : grains) {
        g.reach = 0.01 * std::pow(ratio, random.uniform()) + gap;
        g.centre.x() =
            random.uniform(-1, 1) * (seed % 3 == 0 ? 30 : 1);  // dense, and thinly spread
        g.centre.y() = random.uniform(-0.2, 0.2);
        g.fixed = random.uniform() < 0.1;
      }
      grains[1].centre.x() = grains[0].centre.x();  // same place
      grains[1].centre.y() = grains[0].centre.y();
      HierarchicalGrid<2> grid;
      grid.build(grains);
      std::vector<std::pair<int, int>> found;
      grid.pairs(found);
      EXPECT_EQ(found, all_pairs(grains)) << "ratio " << ratio << " seed " << seed;
      // In three parts, as threads find them and then sort them.
      const int bounds[] = {0, 40, 41, 200};
      IndexPairs some[3], sorted, all;
      for (int part = 0; part < 3; ++part) {
        grid.find_pairs(bounds[part], bounds[part + 1], some[part]);
      }
      const std::span<const std::pair<int, int>> parts[] = {some[0], some[1], some[2]};
      for (int part = 0; part < 3; ++part) {
        HierarchicalGrid<2>::sort_pairs(parts, bounds[part], bounds[part + 1], sorted);
        all.insert(all.end(), sorted.begin(), sorted.end());
      }
      EXPECT_EQ(all, found);
      for (int probe = 0; probe < 50; ++probe) {
        const Reach<2> g{{random.uniform(-1, 1), random.uniform(-0.2, 0.2)},
                         0.01 * std::pow(ratio, random.uniform()),
                         probe % 5 == 0};
        std::vector<int> near, expected;
        grid.near(g, near);
        for (int j = 0; j < 200; ++j) {
          const double dx = grains[j].centre.x() - g.centre.x(),
                       dy = grains[j].centre.y() - g.centre.y();
          const double sum = g.reach + grains[j].reach;
          if (dx * dx + dy * dy < sum * sum && !(g.fixed && grains[j].fixed)) expected.push_back(j);
        }
        EXPECT_EQ(near, expected) << "ratio " << ratio << " seed " << seed;
      }
      auto order = HierarchicalGrid<2>::order(grains);
      std::sort(order.begin(), order.end());
      for (int i = 0; i < 200; ++i) ASSERT_EQ(order[i], i);
    }
  }
}

TEST(Neighbours, FindsExactlyThePairsInSpace) {
  for (const double ratio : {1.0, 20.0}) {
    for (int seed = 0; seed < 10; ++seed) {
      Random random(seed);
      std::vector<Reach<3>> grains(250);
      for (Reach<3>& g : grains) {
        g.reach = 0.05 * std::pow(ratio, -random.uniform());
        const double high = seed % 3 == 0 ? 3 : 0.3;  // a column, and a box
        g.centre = {0.3 * random.uniform(), 0.3 * random.uniform(), high * random.uniform()};
        g.fixed = random.uniform() < 0.1;
      }
      std::vector<std::pair<int, int>> expected, found;
      for (int i = 0; i < 250; ++i) {
        for (int j = i + 1; j < 250; ++j) {
          const double sum = grains[i].reach + grains[j].reach;
          if ((grains[i].centre - grains[j].centre).squaredNorm() < sum * sum &&
              !(grains[i].fixed && grains[j].fixed)) {
            expected.emplace_back(i, j);
          }
        }
      }
      HierarchicalGrid<3> grid;
      grid.build(grains);
      grid.pairs(found);
      EXPECT_EQ(found, expected) << "ratio " << ratio << ", seed " << seed;
      std::vector<int> near;
      grid.near(grains[7], near);
      for (const int j : near) {
        const double sum = grains[7].reach + grains[j].reach;
        EXPECT_LT((grains[7].centre - grains[j].centre).norm(), sum);
      }
      std::vector<int> order = HierarchicalGrid<3>::order(grains);
      std::sort(order.begin(), order.end());
      for (int i = 0; i < 250; ++i) ASSERT_EQ(order[i], i);
    }
  }
}

TEST(Neighbours, EmptyAndSingle) {
  HierarchicalGrid<2> grid;
  std::vector<Reach<2>> grains;
  std::vector<std::pair<int, int>> found{{1, 2}};
  grid.build(grains);
  grid.pairs(found);
  EXPECT_TRUE(found.empty());
  grains.resize(1);
  grains[0].reach = 1;
  grid.build(grains);
  grid.pairs(found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace grainfield::dem
