// Windows of heaps of any shape: convex, counter-clockwise, and full where grains fill them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/specimen/volume_fraction.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"

namespace grainfield::coupling {
namespace {

using namespace dem;

// Flanks of these angles that meet the floor at -left and right.
HeapShape heap(double left_deg, double right_deg, double left, double right, double top_share) {
  HeapShape h;
  h.left.slope = std::tan(left_deg * std::numbers::pi / 180);
  h.right.slope = -std::tan(right_deg * std::numbers::pi / 180);
  h.left.at_zero = h.left.slope * left;
  h.right.at_zero = -h.right.slope * right;
  h.left.columns = h.right.columns = 10;
  h.foot_left = -left;
  h.foot_right = right;
  h.apex_x = (h.left.at_zero - h.right.at_zero) / (h.right.slope - h.left.slope);
  h.height = top_share * (h.left.at_zero + h.left.slope * h.apex_x);
  return h;
}

// One grain that covers everything.
Snapshot everything() {
  Snapshot s;
  Grain g;
  g.outline = {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}};
  g.radius = 10 * std::numbers::sqrt2;
  s.grains = {g};
  return s;
}

TEST(HeapWindows, AreFullWhereGrainsFillThem) {
  Random random(3);
  const Snapshot full = everything();
  int whole = 0, pointed = 0;
  for (int round = 0; round < 5000; ++round) {
    const HeapShape h =
        heap(random.uniform(15, 60), random.uniform(15, 60), random.uniform(0.05, 0.3),
             random.uniform(0.05, 0.3), random.uniform(0.7, 1.2));
    const double d = random.uniform(0.003, 0.012);
    const HeapWindows w = windows_of(h, d);
    for (const Outline* window : {&w.whole, &w.centre, &w.surface_left, &w.surface_right}) {
      if (window->empty()) continue;
      EXPECT_GT(area_of(*window), 0) << round;
      EXPECT_NEAR(volume_fraction(full, *window), 1, 1e-9) << round;
    }
    whole += !w.whole.empty();
    pointed += w.whole.size() == 3;
  }
  EXPECT_GT(whole, 1000);
  EXPECT_GT(pointed, 100);  // the lines meet below the ceiling
}

}  // namespace
}  // namespace grainfield::coupling
