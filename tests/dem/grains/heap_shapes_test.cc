// Families of grains: what is drawn is what was asked for.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "dem/grains/grain_family.h"
#include "dem/grains/packing.h"
#include "dem/shapes/polygon.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

double perimeter(const Outline& outline) {
  double sum = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const auto& p = outline[k];
    const auto& q = outline[(k + 1) % outline.size()];
    sum += std::hypot(q[0] - p[0], q[1] - p[1]);
  }
  return sum;
}

// The circle through three corners: centre and radius.
std::array<double, 3> circle_through(const Outline& o) {
  const double ax = o[1][0] - o[0][0], ay = o[1][1] - o[0][1];
  const double bx = o[2][0] - o[0][0], by = o[2][1] - o[0][1];
  const double d = 2 * (ax * by - ay * bx), a = ax * ax + ay * ay, b = bx * bx + by * by;
  const double x = (by * a - ay * b) / d, y = (ax * b - bx * a) / d;
  return {o[0][0] + x, o[0][1] + y, std::hypot(x, y)};
}

ShapeSetup rand1(double axis_ratio, int least, int most) {
  ShapeSetup s;
  s.kind = "rand1";
  s.radius = 2;
  s.polydispersity = 0.3;
  s.corners_min = least;
  s.corners_max = most;
  s.axis_ratio = axis_ratio;
  return s;
}

TEST(GrainFamily, Rand1CornersLieOnTheCircleInTheirGaps) {
  Random random(4);
  const ShapeSetup s = rand1(1, 6, 8);
  std::vector<int> corners(9, 0);
  double least_radius = 9, most_radius = 0, closest = 9, widest = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const ShapedGrain g = draw_grain(s, random);
    const auto n = g.outline.size();
    ++corners[n];
    const auto [x, y, radius] = circle_through(g.outline);
    EXPECT_GE(radius, 2 * 0.7 * (1 - 1e-9));
    EXPECT_LE(radius, 2 * 1.3 * (1 + 1e-9));
    least_radius = std::min(least_radius, radius);
    most_radius = std::max(most_radius, radius);
    const double mean = 2 * std::numbers::pi / static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k) {
      const auto& p = g.outline[k];
      const auto& q = g.outline[(k + 1) % n];
      EXPECT_NEAR(std::hypot(p[0] - x, p[1] - y), radius, 1e-9);
      const double turn = std::atan2(q[1] - y, q[0] - x) - std::atan2(p[1] - y, p[0] - x);
      const double gap = std::fmod(turn + 4 * std::numbers::pi, 2 * std::numbers::pi) / mean;
      EXPECT_GE(gap, 0.6 - 1e-9);
      EXPECT_LE(gap, 1.6 + 1e-9);
      closest = std::min(closest, gap);
      widest = std::max(widest, gap);
    }
    EXPECT_NEAR(g.area, area_of(g.outline), 1e-12);
    EXPECT_NEAR(g.radius, circumradius_of(g.outline), 1e-12);
  }
  // The whole ranges are used.
  EXPECT_LT(least_radius, 1.41);
  EXPECT_GT(most_radius, 2.59);
  EXPECT_LT(closest, 0.601);
  EXPECT_GT(widest, 1.59);
  for (int n = 6; n <= 8; ++n) EXPECT_NEAR(corners[n], 5000 / 3, 150) << n;
}

TEST(GrainFamily, EllipsesHaveTheirAxisRatioAndTheCirclesArea) {
  Random random(6);
  ShapeSetup s = rand1(2, 60, 60);
  s.polydispersity = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const ShapedGrain g = draw_grain(s, random);
    const auto [xx, yy, xy] = second_moments_of(g.outline);
    EXPECT_NEAR(std::sqrt(xx / yy), 2, 0.05);
    EXPECT_NEAR(g.area, 4 * std::numbers::pi, 0.15);
    EXPECT_NEAR(xy / xx, 0, 0.05);
  }
  // Down to triangles every outline is convex and has its centroid at the origin.
  for (const int n : {3, 4, 5, 20}) {
    for (const double ratio : {1.0, 2.0, 5.0}) {
      const ShapeSetup few = rand1(ratio, n, n);
      for (int trial = 0; trial < 300; ++trial) {
        const ShapedGrain g = draw_grain(few, random);
        EXPECT_EQ(static_cast<int>(g.outline.size()), n);
        EXPECT_NEAR(centroid_of(g.outline)[0], 0, 1e-12);
        EXPECT_NEAR(centroid_of(g.outline)[1], 0, 1e-12);
      }
    }
  }
}

TEST(GrainFamily, AnglesAreUniform) {
  Random random(8);
  double cosine = 0, sine = 0;
  const int n = 4000;
  for (int k = 0; k < n; ++k) {
    const ShapedGrain g = draw_grain(rand1(1, 7, 7), random);
    EXPECT_LE(std::fabs(g.angle), std::numbers::pi);
    cosine += std::cos(g.angle) / n;
    sine += std::sin(g.angle) / n;
  }
  EXPECT_NEAR(std::hypot(cosine, sine), 0, 4 / std::sqrt(2.0 * n));
}

TEST(GrainFamily, RegularIrregularAndGivenOutlines) {
  Random random(3);
  ShapeSetup s;
  s.radius = 0.5;
  s.polydispersity = 0;
  s.kind = "regular";
  s.corners_min = s.corners_max = 6;
  EXPECT_NEAR(draw_grain(s, random).area, 1.5 * std::sqrt(3) * 0.25, 1e-14);
  s.kind = "irregular";
  s.side = 0.009;
  double least = 1, most = 0;
  for (int k = 0; k < 2000; ++k) {
    const ShapedGrain g = draw_grain(s, random);
    ASSERT_EQ(g.outline.size(), 5u);
    EXPECT_NEAR(perimeter(g.outline), 5 * 0.009, 1e-15);
    for (std::size_t i = 0; i < 5; ++i) {
      const auto& p = g.outline[i];
      const auto& q = g.outline[(i + 1) % 5];
      least = std::min(least, std::hypot(q[0] - p[0], q[1] - p[1]));
      most = std::max(most, std::hypot(q[0] - p[0], q[1] - p[1]));
    }
  }
  EXPECT_LT(least, 0.8 * 0.009);  // irregular indeed
  EXPECT_GT(most, 1.2 * 0.009);
  s.side = 0;
  EXPECT_NEAR(perimeter(draw_grain(s, random).outline),
              5 * 2 * 0.5 * std::sin(std::numbers::pi / 5), 1e-14);
  s.kind = "outline";
  s.outline = {3, 3, 5, 3, 5, 5, 3, 5};
  const ShapedGrain g = draw_grain(s, random);
  EXPECT_NEAR(g.area, 1, 1e-15);
  EXPECT_NEAR(g.radius, std::sqrt(0.5), 1e-15);
  s.kind = "disk";
  EXPECT_TRUE(draw_grain(s, random).outline.empty());
  EXPECT_EQ(draw_grain(s, random).angle, 0);
}

TEST(GrainFamily, ExtremesAndSums) {
  Random random(1);
  std::vector<ShapedGrain> grains;
  for (int k = 0; k < 100; ++k) grains.push_back(draw_grain(rand1(1, 6, 8), random));
  const GrainExtremes e = extremes_of(grains, 3);
  for (const ShapedGrain& g : grains) {
    EXPECT_LE(e.least_mass, 3 * g.area);
    EXPECT_LE(edge_steepness(g.outline) / std::sqrt(3 * g.area),
              e.steepest_edge / std::sqrt(e.steep_mass));
  }
  grains = {disk_grain(1), disk_grain(3)};
  EXPECT_EQ(extremes_of(grains, 1).steepest_edge, 0);
  EXPECT_DOUBLE_EQ(extremes_of(grains, 1).least_mass, std::numbers::pi);
  EXPECT_DOUBLE_EQ(total_area(grains), 10 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(mean_radius(grains), 2);
  EXPECT_DOUBLE_EQ(largest_radius(grains), 3);
}

TEST(GrainFamily, SideBySideWithoutOverlapAndInside) {
  Random random(7);
  const std::vector<ShapedGrain> grains = {disk_grain(1), disk_grain(2), disk_grain(0.5)};
  for (const double width : {7.0, 7.5, 20.0}) {
    const auto row = side_by_side(grains, -2, width - 2, 3, 5, random);
    EXPECT_GE(row[0].x - 1, -2 - 1e-12);
    EXPECT_GE(row[1].x - row[0].x, 3 - 1e-12);
    EXPECT_GE(row[2].x - row[1].x, 2.5 - 1e-12);
    EXPECT_LE(row[2].x + 0.5, width - 2 + 1e-12);
    for (const NewGrain& g : row) EXPECT_DOUBLE_EQ(g.y - g.radius, 3);
  }
}

std::string refusal(const ShapeSetup& s) {
  return refusal_of([&] { check_shape(s); });
}

TEST(GrainFamily, RefusesWhatIsNoGrain) {
  ShapeSetup s;
  EXPECT_EQ(refusal(s), "accepted");
  s.polydispersity = 1;
  EXPECT_THAT(refusal(s), testing::StartsWith("shape.polydispersity: found 1, allowed: 0 to 0.99"));
  s.polydispersity = -0.1;
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.polydispersity: found -0.1"));
  s = ShapeSetup{};
  s.radius = 0;
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.radius: found 0, allowed: above 0"));
  s = ShapeSetup{};
  s.corners_min = 2;
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.corners_min: found 2, allowed: 3"));
  s.corners_min = 9;
  EXPECT_THAT(
      refusal(s),
      testing::HasSubstr("shape.corners_max: found 8, allowed: at least shape.corners_min = 9"));
  s = ShapeSetup{};
  s.corners_max = kMostCorners + 1;
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.corners_max: found 65, allowed: at most 64"));
  s = ShapeSetup{};
  s.axis_ratio = 0.5;
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.axis_ratio: found 0.5, allowed: 1 to 5"));
  s = ShapeSetup{};
  s.kind = "irregular";
  s.side = -1;
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.side: found -1"));
  s = ShapeSetup{};
  s.side = 0.003;  // of rand1
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.side: found 0.003, allowed: 0, because only"));
}

TEST(GrainFamily, RefusesOutlinesThatAreNotConvexPolygons) {
  ShapeSetup s;
  s.kind = "outline";
  s.outline = {0, 0, 1, 0, 1};
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.outline: found 5 numbers, allowed: pairs"));
  const std::vector<std::vector<double>> bad = {
      {},                                // nothing
      {0, 0, 1, 0},                      // two corners
      {0, 0, 2, 0, 2, 2, 1, 0.5, 0, 2},  // a dent
      {0, 0, 1, 1, 1, 0, 0, 1},          // crosses itself
      {0, 0, 1, 0, 1, 0, 0, 1},          // a corner twice
      {0, 0, 100, 0, 100, 1, 0, 1},      // a sliver
      {0, 0, 1, 0, std::numeric_limits<double>::quiet_NaN(), 1},
  };
  for (const auto& outline : bad) {
    s.outline = outline;
    EXPECT_THAT(refusal(s), testing::StartsWith("shape.outline: ")) << outline.size();
  }
  s.outline = {0, 0, 1, 0, 1, 1, 0, 1};
  EXPECT_EQ(refusal(s), "accepted");
  for (double& corner : s.outline) corner *= 0.00275;  // in metres
  EXPECT_THAT(refusal(s), testing::HasSubstr("corners are in units of shape.radius"));
}

TEST(GrainSupply, PentagonsFillRowsAndStayWithinTheirBounds) {
  PackingSetup p;
  p.shape = "irregular";
  p.width = 0.3;
  p.depth = 0.1;
  Random random(5);
  GrainSupply supply(p, random);
  for (int row = 0; row < 5; ++row) {
    double width = 0;
    for (const ShapedGrain& g : supply.fill(p.width, random)) {
      EXPECT_EQ(g.outline.size(), 5u);
      EXPECT_LE(g.radius, largest_radius(p));
      width += 2 * g.radius;
    }
    EXPECT_LE(width, p.width * (1 + 1e-9));
    EXPECT_GT(width, p.width - 2 * largest_radius(p));
  }
  EXPECT_THROW(
      {
        while (true) supply.fill(p.width, random);
      },
      ComputationFailed);
  p.kind = "triangular";
  p.sizes = "mono";
  EXPECT_THROW(check_packing(p), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::dem
