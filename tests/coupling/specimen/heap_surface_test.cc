// The free surface of synthetic heaps whose slopes are known.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "coupling/specimen/surface.h"
#include "coupling/specimen/volume_fraction.h"
#include "dem/random/random.h"

namespace grainfield::coupling {
namespace {

using namespace dem;

constexpr double kDegrees = 180 / std::numbers::pi;

struct Triangle {
  double left_deg, right_deg, height, apex = 0;

  double surface(double x) const {
    const double slope = x < apex ? std::tan(left_deg / kDegrees) : std::tan(right_deg / kDegrees);
    return height - slope * std::fabs(x - apex);
  }
  double foot_left() const { return apex - height / std::tan(left_deg / kDegrees); }
  double foot_right() const { return apex + height / std::tan(right_deg / kDegrees); }
};

Grain disk(double x, double y, double r) {
  Grain g;
  g.position = Vec3(x, y, 0);
  g.radius = r;
  g.volume = std::numbers::pi * r * r;
  return g;
}

// Disks on a square lattice under the triangle, shaken by `shake` radii.
Snapshot heap_of_disks(const Triangle& t, double r, double shake, Random& random) {
  Snapshot s;
  for (double y = r; y < t.height; y += 2 * r) {
    for (double x = t.foot_left(); x < t.foot_right(); x += 2 * r) {
      const double px = x + shake * r * random.uniform(-1, 1);
      const double py = y + shake * r * random.uniform(-1, 1);
      if (py + r < t.surface(px)) s.grains.push_back(disk(px, py, r));
    }
  }
  return s;
}

TEST(FreeSurface, IsTheHighestPointInEachColumn) {
  Snapshot s;
  s.grains = {disk(0.5, 2, 1), disk(2.5, 1, 0.25)};
  Grain square = disk(5.25, 1, std::sqrt(2.0));
  square.outline = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  s.grains.push_back(square);
  square.position.x() = 9;
  square.angle = 45 / kDegrees;
  s.grains.push_back(square);
  Grain fixed = disk(20, 50, 1);
  fixed.fixed = true;
  s.grains.push_back(fixed);
  const Surface surface = free_surface(s, 1);
  EXPECT_DOUBLE_EQ(surface.left, -1);
  const auto top = [&](double x) {
    return surface.top[static_cast<std::size_t>(std::floor(x - surface.left))];
  };
  EXPECT_NEAR(top(-0.5), 2 + std::sqrt(0.75), 1e-12);  // cut at x = 0
  EXPECT_NEAR(top(0.5), 3, 1e-12);
  EXPECT_NEAR(top(2.5), 1.25, 1e-12);
  EXPECT_EQ(top(3.5), 0);
  EXPECT_NEAR(top(4.5), 2, 1e-12);
  EXPECT_NEAR(top(5.5), 2, 1e-12);
  EXPECT_NEAR(top(9.5), 1 + std::sqrt(2), 1e-12);
  EXPECT_NEAR(top(7.9), std::sqrt(2), 1e-12);  // edge of slope 1 at x = 8
  EXPECT_THROW(free_surface(s, 0), std::invalid_argument);
  EXPECT_TRUE(free_surface(Snapshot{}, 1).top.empty());
}

Surface exact_surface(const Triangle& t, double column) {
  Surface s;
  s.column = column;
  s.left = t.foot_left();
  for (double x = s.left; x < t.foot_right(); x += column) {
    s.top.push_back(std::max(0.0, t.surface(x + 0.5 * column)));
  }
  return s;
}

TEST(HeapShape, ComesBackExactlyFromStraightFlanks) {
  for (const double left : {18.0, 28.0, 45.0}) {
    for (const double right : {21.0, 31.0}) {
      const Triangle t{left, right, 0.3, 0.07};
      const HeapShape h = measure_heap(exact_surface(t, 0.003));
      EXPECT_NEAR(h.repose_left_deg, left, 1e-9);
      EXPECT_NEAR(h.repose_right_deg, right, 1e-9);
      EXPECT_NEAR(h.apex_x, t.apex, 1e-9);
      EXPECT_NEAR(h.foot_left, t.foot_left(), 1e-9);
      EXPECT_NEAR(h.half_base_right(), t.foot_right() - t.apex, 1e-9);
      EXPECT_NEAR(h.height, 0.3, 0.003);
      EXPECT_NEAR(h.repose_left_error_deg, 0, 1e-9);
    }
  }
}

// Rough flanks: the angle is right within its own error in most of many heaps, and the mean over
// all of them within the error of the mean: there is no bias.
TEST(HeapShape, RoughFlanksGiveUnbiasedAnglesAndHonestErrors) {
  const Triangle t{31, 22, 0.25};
  Random random(5);
  int within = 0;
  double mean = 0;
  const int n = 400;
  for (int k = 0; k < n; ++k) {
    Surface s = exact_surface(t, 0.006);
    for (double& y : s.top) y = std::max(0.0, y + 0.004 * random.uniform(-1, 1));
    const HeapShape h = measure_heap(s);
    within += std::fabs(h.repose_left_deg - 31) < 2 * h.repose_left_error_deg;
    mean += h.repose_right_deg / n;
  }
  EXPECT_GT(within, 0.85 * n);
  EXPECT_NEAR(mean, 22, 0.05);
}

TEST(HeapShape, OutliersLeaveTheAnglesAlone) {
  const Triangle t{28, 28, 0.3};
  Surface s = exact_surface(t, 0.005);
  for (std::size_t k = 5; k < s.top.size(); k += 9) s.top[k] += 0.01;  // a grain on the flank
  s.top.insert(s.top.end(), {0, 0, 0.005, 0, 0.005, 0, 0});            // grains that rolled away
  const HeapShape h = measure_heap(s);
  EXPECT_NEAR(h.repose_left_deg, 28, 0.2);
  EXPECT_NEAR(h.repose_right_deg, 28, 0.2);
}

TEST(HeapShape, HeapsOfGrainsHaveTheirTrianglesAngles) {
  Random random(2);
  for (const double left : {27.0, 31.0}) {
    for (const double right : {21.0, 28.0}) {
      const Triangle t{left, right, 0.3};
      const double r = 0.00275;
      const HeapShape h = measure_heap(free_surface(heap_of_disks(t, r, 0.5, random), 4 * r));
      EXPECT_NEAR(h.repose_left_deg, left, 1);
      EXPECT_NEAR(h.repose_right_deg, right, 1);
      EXPECT_NEAR(h.height, 0.3, 4 * r);
      EXPECT_NEAR(h.apex_x, 0, 8 * r);
    }
  }
}

TEST(HeapShape, TooSmallHeapsGiveNan) {
  const HeapShape none = measure_heap(Surface{});
  EXPECT_TRUE(std::isnan(none.height));
  const HeapShape tiny = measure_heap(exact_surface({30, 30, 0.01}, 0.005));
  EXPECT_TRUE(std::isnan(tiny.repose_left_deg));
  EXPECT_TRUE(std::isnan(tiny.apex_x));
  EXPECT_TRUE(windows_of(tiny, 0.005).whole.empty());
}

TEST(CommonArea, OfShiftedAndTurnedSquares) {
  const Outline unit = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Outline other = unit;
  for (auto& p : other) p = {p[0] + 0.25, p[1] - 0.5};
  EXPECT_NEAR(common_area(unit, other), 0.375, 1e-14);
  const Outline diamond = {{0.5, -0.5}, {1.5, 0.5}, {0.5, 1.5}, {-0.5, 0.5}};
  EXPECT_NEAR(common_area(unit, diamond), 1, 1e-14);
  const Outline small = {{0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}};
  EXPECT_NEAR(common_area(small, unit), 0.5, 1e-14);
  for (auto& p : other) p = {p[0] + 5, p[1]};
  EXPECT_EQ(common_area(unit, other), 0);
}

TEST(VolumeFraction, OfLatticesIsExact) {
  Snapshot s;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) s.grains.push_back(disk(i + 0.5, j + 0.5, 0.5));
  }
  // Whole lattice cells: the disks cut by the window make up whole ones.
  EXPECT_NEAR(volume_fraction(s, {{5, 5}, {15, 5}, {15, 15}, {5, 15}}), std::numbers::pi / 4,
              1e-12);
  EXPECT_NEAR(volume_fraction(s, {{5.5, 5.5}, {14.5, 5.5}, {14.5, 14.5}, {5.5, 14.5}}),
              std::numbers::pi / 4, 1e-12);
  Snapshot tiles;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      Grain g = disk(i, j, std::sqrt(0.5));
      g.outline = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
      tiles.grains.push_back(g);
    }
  }
  EXPECT_NEAR(volume_fraction(tiles, {{1.3, 1.1}, {7.2, 2.4}, {4.4, 7.9}}), 1, 1e-12);
  EXPECT_THROW(volume_fraction(tiles, {{0, 0}, {1, 1}}), std::invalid_argument);
}

TEST(HeapWindows, LieInsideTheHeapAndFindItsVolumeFraction) {
  Random random(1);
  const Triangle t{31, 22, 0.3, 0.05};
  const double r = 0.00275;
  const Snapshot s = heap_of_disks(t, r, 0, random);
  const HeapWindows w = windows_of(measure_heap(exact_surface(t, 2 * r)), 2 * r);
  for (const Outline& window : {w.whole, w.centre, w.surface_left, w.surface_right}) {
    ASSERT_FALSE(window.empty());
    for (const auto& p : window) {
      EXPECT_GE(p[1], 2 * r * (1 - 1e-9));
      EXPECT_LT(p[1], t.surface(p[0]));
    }
    EXPECT_NEAR(volume_fraction(s, window), std::numbers::pi / 4, 0.02);
  }
}

TEST(Plateau, IsWhereTheLastLayerStillStands) {
  Surface s;
  s.left = -10;
  s.column = 1;
  s.top = {0, 0, 1, 4, 5, 6, 5, 6, 6, 5, 6, 6, 5, 6, 4, 3, 2, 1, 0, 0};
  const Stretch p = plateau_of(s, {-8, 8}, 1.5);
  EXPECT_DOUBLE_EQ(p.left, -7);
  EXPECT_DOUBLE_EQ(p.right, 5);
  // Not beyond the last layer.
  const Stretch q = plateau_of(s, {-3.25, 2.25}, 1.5);
  EXPECT_DOUBLE_EQ(q.left, -3);
  EXPECT_DOUBLE_EQ(q.right, 2);
  EXPECT_EQ(plateau_of(s, {50, 60}, 1).length(), 0);
}

}  // namespace
}  // namespace grainfield::coupling
