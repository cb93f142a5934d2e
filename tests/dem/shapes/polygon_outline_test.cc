// Moments of outlines in closed form, and what is wrong with an outline that a user gave.
#include <gmock/gmock.h>

#include "tests/dem/polygon_scene.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

TEST(PolygonOutline, RegularPolygonsInClosedForm) {
  for (int n = 3; n <= 64; ++n) {
    for (const double radius : {1e-3, 1.0, 50.0}) {
      Outline outline = regular(n, radius, 0.3);
      const double step = 2 * std::numbers::pi / n;
      const double area = n / 2.0 * radius * radius * std::sin(step);
      const double polar = area * radius * radius / 6 * (2 + std::cos(step));
      // Away from the origin the corners themselves are rounded to 1e-16 of their distance, 3 r.
      for (auto& [x, y] : outline) {
        x += 3 * radius;
        y -= 2 * radius;
      }
      EXPECT_NEAR(area_of(outline), area, 1e-14 * n * area);
      EXPECT_NEAR(centroid_of(outline)[0], 3 * radius, 1e-14 * n * radius);
      EXPECT_NEAR(centroid_of(outline)[1], -2 * radius, 1e-14 * n * radius);
      EXPECT_NEAR(polar_moment_of(outline), polar, 1e-13 * n * polar);
      const auto second = second_moments_of(outline);
      EXPECT_NEAR(second[0], polar / 2, 1e-13 * n * polar);
      EXPECT_NEAR(second[1], polar / 2, 1e-13 * n * polar);
      EXPECT_NEAR(second[2], 0, 1e-13 * n * polar);
      EXPECT_NEAR(circumradius_of(outline), radius, 1e-13 * radius);
      EXPECT_NEAR(edge_steepness(outline), 4 * std::tan(step / 2), 1e-11);
    }
  }
}

TEST(PolygonOutline, BoxAndTriangleInClosedForm) {
  const Outline wide = box(4, 1);
  EXPECT_DOUBLE_EQ(area_of(wide), 4);
  using testing::DoubleNear;
  EXPECT_THAT(second_moments_of(wide),
              testing::ElementsAre(DoubleNear(64.0 / 12, 1e-14), DoubleNear(4.0 / 12, 1e-14),
                                   DoubleNear(0, 1e-14)));
  EXPECT_DOUBLE_EQ(edge_steepness(wide), 16);  // 2 * 4 / 0.5
  const Outline triangle = {{0, 0}, {3, 0}, {0, 6}};
  EXPECT_NEAR(second_moments_of(triangle)[0], 9 * 9 / 18.0, 1e-13);    // A b^2 / 18
  EXPECT_NEAR(second_moments_of(triangle)[1], 9 * 36 / 18.0, 1e-13);   // A h^2 / 18
  EXPECT_NEAR(second_moments_of(triangle)[2], -9 * 18 / 36.0, 1e-13);  // -A b h / 36
}

TEST(PolygonOutline, CentredIsCounterClockwiseAboutTheCentroid) {
  Random random(3);
  for (int k = 0; k < 300; ++k) {
    Outline outline = random_outline(random, 3 + k % 62, 0.7, random.uniform(1, 4));
    for (auto& [x, y] : outline) x += 5;
    if (k % 2 == 0) std::reverse(outline.begin(), outline.end());
    const Outline centred = centred_outline(outline);
    ASSERT_EQ(centred.size(), outline.size());
    EXPECT_GT(area_of(centred), 0);
    EXPECT_NEAR(centroid_of(centred)[0], 0, 1e-14);
    EXPECT_NEAR(centroid_of(centred)[1], 0, 1e-14);
    EXPECT_NEAR(std::fabs(area_of(outline)), area_of(centred), 1e-14);
  }
  // A straight corner is allowed.
  EXPECT_EQ(centred_outline({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}).size(), 5u);
}

std::string complaint(const Outline& outline) {
  try {
    centred_outline(outline);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(PolygonOutline, SaysWhatIsWrongWithWhichCorner) {
  EXPECT_EQ(complaint({{0, 0}, {1, 0}}),
            "an outline needs at least 3 corners (x1, y1, x2, y2, x3, y3), found 2");
  EXPECT_EQ(complaint(regular(65, 1)), "an outline has at most 64 corners, found 65");
  EXPECT_THAT(complaint({{0, 0}, {NAN, 0}, {0, 1}}), HasSubstr("corner 2 (nan, 0) is not a pair"));
  EXPECT_THAT(complaint({{0, 0}, {INFINITY, 0}, {0, 1}}), HasSubstr("corner 2 (inf, 0)"));
  EXPECT_EQ(complaint({{0, 0}, {1, 0}, {1, 1}, {0, 0}}),
            "corner 4 (0, 0) coincides with corner 1: give each corner once");
  EXPECT_EQ(complaint({{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}),
            "corner 3 (0.5, 0.5) turns inwards: the outline is not convex; leave that corner out, "
            "or give the convex hull");
  EXPECT_EQ(complaint({{0, 2}, {0.5, 0.5}, {2, 0}, {0, 0}}),  // the same, clockwise
            "corner 2 (0.5, 0.5) turns inwards: the outline is not convex; leave that corner out, "
            "or give the convex hull");
  EXPECT_EQ(complaint({{0, 0}, {2, 2}, {2, 0}, {0, 1}}),
            "the edge from corner 1 (0, 0) crosses the edge from corner 3 (2, 0): the outline "
            "crosses itself; list the corners in their order round the grain");
  Outline star;
  for (int k = 0; k < 5; ++k) star.push_back(regular(5, 1)[(2 * k) % 5]);
  EXPECT_THAT(complaint(star), HasSubstr("crosses itself"));
  EXPECT_EQ(complaint(box(21, 1)),
            "the outline is a sliver: its longest extent 21.0238 is more than 20 times its "
            "shortest one, 1; give it more width");
  EXPECT_THAT(complaint({{0, 0}, {1, 1}, {2, 2}}), HasSubstr("sliver"));
  EXPECT_EQ(complaint({{0, 0}, {2, 0}, {3, 0}, {2.5, 0}, {1, 1}}),
            "corner 3 (3, 0) turns straight back: the outline folds; list the corners in their "
            "order round the grain");
}

}  // namespace
}  // namespace grainfield::dem
