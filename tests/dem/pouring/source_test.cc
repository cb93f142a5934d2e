// Sources of piles.
#include "dem/pouring/source.h"

#include <gtest/gtest.h>

namespace grainfield::dem {
namespace {

TEST(PointSource, FallsFreely) {
  SourceSetup setup;
  setup.grains = 11;
  setup.move = 0.2;
  const PointSource source(setup, 9.81, 1e-5);
  EXPECT_EQ(source.release_step(3), 30000);
  EXPECT_DOUBLE_EQ(source.axis(0), -0.1);
  EXPECT_DOUBLE_EQ(source.axis(10), 0.1);
  const long step = source.arrival_step(3, 0.1);
  NewGrain g;
  source.place(g, 3, step);
  EXPECT_NEAR(g.y, 0.1, 1e-5 * 3);
  EXPECT_GE(g.y, 0.1);
  // Energy: v^2 = v0^2 + 2 g (height - y).
  EXPECT_NEAR(g.vy * g.vy, 0.04 + 2 * 9.81 * (0.5 - g.y), 1e-12);
  EXPECT_EQ(source.arrival_step(3, 0.7), 30000);
  EXPECT_NEAR(least_interval(0, 9.81, 0.5 * 9.81), 1, 1e-14);
  EXPECT_NEAR(least_interval(2, 1e-300, 0.5), 0.25, 1e-14);
}

}  // namespace
}  // namespace grainfield::dem
