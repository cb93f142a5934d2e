// Overlap area, crossings and moments of random polygons against Boost.Geometry.
#include <gmock/gmock.h>

// Without this Boost 1.74 rounds the corners to a grid of 1e-7 of their extent before it looks for
// the crossings, and light contacts vanish.
#define BOOST_GEOMETRY_NO_ROBUSTNESS
#include <boost/geometry/algorithms/append.hpp>
#include <boost/geometry/algorithms/area.hpp>
#include <boost/geometry/algorithms/centroid.hpp>
#include <boost/geometry/algorithms/intersection.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/strategies/strategies.hpp>

#include "tests/dem/polygon_scene.h"

namespace grainfield::dem {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point, false, true>;  // counter-clockwise, closed
using Line = bg::model::linestring<Point>;

Polygon boost_polygon(const Outline& corners) {
  Polygon polygon;
  for (const auto& [x, y] : corners) bg::append(polygon.outer(), Point(x, y));
  bg::append(polygon.outer(), Point(corners[0][0], corners[0][1]));
  return polygon;
}

double boost_area(const Polygon& a, const Polygon& b) {
  std::vector<Polygon> pieces;
  bg::intersection(a, b, pieces);
  double area = 0;
  for (const Polygon& piece : pieces) area += bg::area(piece);
  return area;
}

TEST(PolygonBoost, AreaAndCrossingsOfRandomPairs) {
  Random random(11);
  int overlapping = 0, apart = 0, two_crossings = 0, more = 0;
  double worst = 0;
  for (int k = 0; k < 120000; ++k) {
    const auto [a, b] = random_pair(random, k);
    const Overlap o = overlap_of(a, b);
    const Polygon pa = boost_polygon(a.corners()), pb = boost_polygon(b.corners());
    const double scale = std::min(a.area(), b.area());
    const double exact = area_in_long_double(a.corners(), b.corners());
    const double expected = boost_area(pa, pb);
    worst = std::max(worst, std::fabs(o.area - exact) / scale);
    ASSERT_NEAR(o.area, exact, 1e-12 * scale) << "pair " << k;
    ASSERT_NEAR(o.area, expected, 1e-10 * scale) << "pair " << k;
    (o.area > 0 ? overlapping : apart) += 1;
    std::vector<Point> crossings;
    const Line la(pa.outer().begin(), pa.outer().end()), lb(pb.outer().begin(), pb.outer().end());
    bg::intersection(la, lb, crossings);
    if (crossings.size() == 2) {
      ++two_crossings;
      const double dx = crossings[1].x() - crossings[0].x(),
                   dy = crossings[1].y() - crossings[0].y();
      const auto s = contact_point(a, o);
      // The crossing of two sides moves by round-off over the sine of their angle: a part in 1e9 of
      // the pairs' size bounds it at the smallest angle that 120,000 draws meet.
      ASSERT_NEAR(o.chord, std::hypot(dx, dy), 1e-9) << "pair " << k;
      ASSERT_NEAR(s[0], (crossings[0].x() + crossings[1].x()) / 2, 1e-9) << "pair " << k;
      ASSERT_NEAR(s[1], (crossings[0].y() + crossings[1].y()) / 2, 1e-9) << "pair " << k;
      ASSERT_NEAR(o.nx * dx + o.ny * dy, 0, 1e-9) << "pair " << k;
    } else if (crossings.size() > 2) {
      ++more;
    }
  }
  // Every kind must have been met.
  EXPECT_GT(overlapping, 80000);
  EXPECT_GT(apart, 10000);
  EXPECT_GT(two_crossings, 50000);
  EXPECT_GT(more, 2000);
  // 1:100 in size: round-off of the larger one's edges against the smaller one's area.
  EXPECT_LT(worst, 1e-12);
}

// Second moments about `centre` (xx, yy, xy) of the triangles between it and the sides: of one
// triangle area / 12 (sum of v v' over its corners + s s'), s the sum of its corners.
std::array<double, 3> moments_by_triangles(const Outline& outline, const Point& centre) {
  std::array<double, 3> m{};
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const auto& p = outline[k];
    const auto& q = outline[(k + 1) % outline.size()];
    const double ax = p[0] - centre.x(), ay = p[1] - centre.y();
    const double bx = q[0] - centre.x(), by = q[1] - centre.y();
    const double w = (ax * by - ay * bx) / 24;
    m[0] += w * (ax * ax + bx * bx + (ax + bx) * (ax + bx));
    m[1] += w * (ay * ay + by * by + (ay + by) * (ay + by));
    m[2] += w * (ax * ay + bx * by + (ax + bx) * (ay + by));
  }
  return m;
}

TEST(PolygonBoost, CentroidAndMoments) {
  Random random(12);
  for (int k = 0; k < 2000; ++k) {
    Outline outline =
        random_outline(random, 3 + k % 30, random.uniform(0.1, 2), random.uniform(1, 5));
    for (auto& [x, y] : outline) {
      x += 3;
      y -= 2;
    }
    const Polygon polygon = boost_polygon(outline);
    Point centroid(0, 0);
    bg::centroid(polygon, centroid);
    EXPECT_NEAR(area_of(outline), bg::area(polygon), 1e-13);
    EXPECT_NEAR(centroid_of(outline)[0], centroid.x(), 1e-12);
    EXPECT_NEAR(centroid_of(outline)[1], centroid.y(), 1e-12);
    const auto exact = moments_by_triangles(outline, centroid), ours = second_moments_of(outline);
    const double polar = exact[0] + exact[1];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(ours[c], exact[c], 1e-12 * polar);
    EXPECT_NEAR(polar_moment_of(outline), polar, 1e-12 * polar);
  }
}

}  // namespace
}  // namespace grainfield::dem
