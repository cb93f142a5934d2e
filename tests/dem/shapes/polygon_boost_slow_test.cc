// Overlap area, crossings and moments of random polygons against Boost.Geometry.
#include <gmock/gmock.h>

// Without this Boost 1.74 rounds the corners to a grid of 1e-7 of their extent before it looks for
// the crossings, and light contacts vanish.
#define BOOST_GEOMETRY_NO_ROBUSTNESS
#include <boost/geometry/algorithms/append.hpp>
#include <boost/geometry/algorithms/area.hpp>
#include <boost/geometry/algorithms/centroid.hpp>
#include <boost/geometry/algorithms/covered_by.hpp>
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

// A crossing of two outlines: where it is, and +1 where A's outline leaves B, -1 where it enters.
struct Crossing {
  double along = 0;  // number of A's side and part of it
  double x = 0, y = 0, sigma = 0;
};

// Boost's crossings in their order along A's outline, each with its sense from whether the middle
// of A's piece behind it is in B. Empty when they do not enter and leave in turn (grazing
// contacts).
std::vector<Crossing> crossings_along(const Outline& a, const Polygon& b,
                                      const std::vector<Point>& points) {
  const int sides = static_cast<int>(a.size());
  const auto at = [&](double along) {
    const int k = static_cast<int>(along);
    const auto &p = a[k % sides], &q = a[(k + 1) % sides];
    const double t = along - k;
    return Point(p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]));
  };
  std::vector<Crossing> out;
  for (const Point& point : points) {
    Crossing c{0, point.x(), point.y(), 0};
    double least = 1e300;
    for (int k = 0; k < sides; ++k) {
      const auto &p = a[k], &q = a[(k + 1) % sides];
      const double ex = q[0] - p[0], ey = q[1] - p[1], dx = c.x - p[0], dy = c.y - p[1];
      const double t = std::clamp((dx * ex + dy * ey) / (ex * ex + ey * ey), 0.0, 1.0);
      const double away = std::hypot(dx - t * ex, dy - t * ey);
      if (away < least) {
        least = away;
        c.along = k + t;
      }
    }
    out.push_back(c);
  }
  std::sort(out.begin(), out.end(),
            [](const Crossing& p, const Crossing& q) { return p.along < q.along; });
  for (std::size_t k = 0; k < out.size(); ++k) {
    // Any point of the piece will do when it runs round corners: A is convex, and so is B.
    const double from = out[k].along,
                 to = k + 1 < out.size() ? out[k + 1].along : out[0].along + sides;
    out[k].sigma = bg::covered_by(at((from + to) / 2), b) ? -1 : 1;
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (out[k].sigma == out[(k + 1) % out.size()].sigma) return {};
  }
  return out;
}

TEST(PolygonBoost, AreaAndCrossingsOfRandomPairs) {
  Random random(11);
  int overlapping = 0, apart = 0, two_crossings = 0, more = 0, grazing = 0, deep = 0;
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
    std::vector<Point> points;
    const Line la(pa.outer().begin(), pa.outer().end()), lb(pb.outer().begin(), pb.outer().end());
    bg::intersection(la, lb, points);
    if (points.size() < 2) continue;
    const auto crossings = crossings_along(a.corners(), pb, points);
    if (crossings.empty()) {
      ++grazing;
      continue;
    }
    (crossings.size() == 2 ? two_crossings : more) += 1;
    // docs/shapes.md: b = sum sigma x along t, and s from s.t |b| = sum sigma x.x/2,
    // s.n |b| = sum sigma (x.t)(x.n); the crossing of two sides moves by round-off over the sine of
    // their angle: a part in 1e9 of the pairs' size bounds it at the smallest angle that is met.
    double bx = 0, by = 0, squares = 0, mixed = 0;
    const double ox = crossings[0].x, oy = crossings[0].y;
    for (const Crossing& c : crossings) {
      bx += c.sigma * c.x;
      by += c.sigma * c.y;
    }
    const double chord = std::hypot(bx, by), tx = bx / chord, ty = by / chord;
    if (handed_over(a, b, o.area, chord)) {
      ++deep;
      continue;
    }
    ASSERT_NEAR(o.chord, chord, 1e-9) << "pair " << k;
    ASSERT_NEAR(o.nx * chord, by, 1e-9) << "pair " << k;
    ASSERT_NEAR(o.ny * chord, -bx, 1e-9) << "pair " << k;
    if (chord < 1e-6) continue;
    for (const Crossing& c : crossings) {
      const double x = c.x - ox, y = c.y - oy;
      squares += c.sigma * (x * x + y * y) / 2;
      mixed += c.sigma * (x * tx + y * ty) * (x * ty - y * tx);
    }
    // No further than the region reaches.
    std::vector<Polygon> pieces;
    bg::intersection(pa, pb, pieces);
    double low_t = 1e300, high_t = -1e300, low_n = 1e300, high_n = -1e300;
    for (const Polygon& piece : pieces) {
      for (const Point& p : piece.outer()) {
        const double x = p.x() - ox, y = p.y() - oy;
        low_t = std::min(low_t, x * tx + y * ty);
        high_t = std::max(high_t, x * tx + y * ty);
        low_n = std::min(low_n, x * ty - y * tx);
        high_n = std::max(high_n, x * ty - y * tx);
      }
    }
    if (low_t > high_t) continue;
    const double t = std::clamp(squares / chord, low_t, high_t);
    const double n = std::clamp(mixed / chord, low_n, high_n);
    const auto s = contact_point(a, o);
    const double close = 1e-9 * std::max(1.0, 1e-3 / chord);
    ASSERT_NEAR(s[0], ox + t * tx + n * ty, close) << "pair " << k << " chord " << chord;
    ASSERT_NEAR(s[1], oy + t * ty - n * tx, close) << "pair " << k << " chord " << chord;
  }
  // Every kind must have been met.
  EXPECT_GT(overlapping, 80000);
  EXPECT_GT(apart, 10000);
  EXPECT_GT(two_crossings, 50000);
  EXPECT_GT(more, 2000);
  EXPECT_LT(grazing, 100);
  EXPECT_LT(deep, 6000);
  // 1:100 in size: round-off of the larger one's edges against the smaller one's area.
  EXPECT_LT(worst, 1e-12);
}

// Corner on corner, edge along edge, the same outline twice, mirrored and turned by its own
// symmetry: what random numbers never meet.
TEST(PolygonBoost, AreaOfDegeneratePairs) {
  Random random(13);
  int overlapping = 0, apart = 0;
  for (int k = 0; k < 20000; ++k) {
    const auto [a, b] = degenerate_pair(random, k);
    const double scale = std::min(a.area(), b.area());
    const double expected = boost_area(boost_polygon(a.corners()), boost_polygon(b.corners()));
    const double found = overlap_of(a, b).area;
    ASSERT_NEAR(found, expected, 1e-10 * scale) << "pair " << k;
    (found > 1e-12 * scale ? overlapping : apart) += 1;
  }
  EXPECT_GT(overlapping, 5000);
  EXPECT_GT(apart, 2000);
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
  for (int k = 0; k < 100000; ++k) {
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
