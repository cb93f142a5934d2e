// Paths along which nothing may leap: over corners, and into the other outline until it is
// swallowed.
#include <gtest/gtest.h>

#include "tests/dem/polygon_scene.h"

namespace grainfield::dem {
namespace {

// Largest change of force E A / l n (E = 1), chord times n, contact point and depth per step of a
// path.
struct Jump {
  double force = 0, chord = 0, point = 0, depth = 0;
};
template <class Path>
Jump largest_jump(const Placed& a, const Path& path, int steps) {
  Jump jump;
  Overlap last;
  PairFeature feature;
  for (int k = 0; k <= steps; ++k) {
    const Placed b = path(static_cast<double>(k) / steps);
    Overlap o;
    const bool found = overlap_of_shapes(a.shape(), b.shape(), feature, o);
    EXPECT_TRUE(found) << "the path must stay in contact";
    if (k > 0) {
      const double f = o.area / o.length, g = last.area / last.length;
      const auto p = contact_point(a, o), q = contact_point(a, last);
      jump.force = std::max(jump.force, std::hypot(f * o.nx - g * last.nx, f * o.ny - g * last.ny));
      jump.chord = std::max(jump.chord, std::hypot(o.chord * o.nx - last.chord * last.nx,
                                                   o.chord * o.ny - last.chord * last.ny));
      jump.point = std::max(jump.point, std::hypot(p[0] - q[0], p[1] - q[1]));
      jump.depth = std::max(jump.depth, std::fabs(o.depth - last.depth));
    }
    last = o;
  }
  return jump;
}

TEST(PolygonContinuity, ForceAndContactPointOverCorners) {
  const Placed a(regular(7, 1, 0.2), 0, 0);
  const Placed slab(box(6, 0.4), 0, 0);
  const Outline triangle = {{0, -1}, {0.4, 0.7}, {-0.5, 0.8}}, tilted = box(0.5, 0.8);
  const auto slide = [&](double t) { return Placed(tilted, -0.5 + t, 1.12, 0.4); };
  const auto roll = [&](double t) {
    return Placed(tilted, 1.1 * std::cos(t), 1.1 * std::sin(t), 5 * t);
  };
  const auto over_edge = [&](double t) { return Placed(tilted, 0.2 + 3 * t, 0.55, 0.03); };
  // A corner goes in, through, and out on the other side: two crossings become four.
  const auto pierce = [&](double t) { return Placed(triangle, 0.3, 1.1 - 0.9 * t, 0.15); };
  const auto check = [](const char* name, const Placed& first, const auto& path) {
    const Jump coarse = largest_jump(first, path, 4000), fine = largest_jump(first, path, 32000);
    // Continuous with bounded slopes: eight times finer steps, jumps near an eighth. A jump that
    // does not shrink leaves the ratio at 1; a root at the end of a chord would give 2.8.
    EXPECT_GT(coarse.force / fine.force, 5) << name;
    EXPECT_GT(coarse.chord / fine.chord, 5) << name;
    EXPECT_GT(coarse.point / fine.point, 5) << name;
  };
  check("slide", a, slide);
  check("roll", a, roll);
  check("over the slab's end", slab, over_edge);
  check("pierce", slab, pierce);
}

// Into the other outline until it is wholly inside, and further: through a corner, nearly and
// exactly flush with an edge, and with arcs.
TEST(PolygonContinuity, NothingLeapsWhenAGrainIsSwallowed) {
  const Placed large(box(6, 4), 0, 0);
  const auto into = [](const Placed& grain) {
    return [grain](double t) { return grain.moved(0, 2.2 - 1.9 * t); };
  };
  const auto expect_smooth = [](const char* name, const Placed& first, const auto& path) {
    const Jump coarse = largest_jump(first, path, 4000), fine = largest_jump(first, path, 32000);
    EXPECT_GT(coarse.force / fine.force, 5) << name;
    EXPECT_GT(coarse.chord / fine.chord, 5) << name;
    EXPECT_GT(coarse.point / fine.point, 5) << name;
    EXPECT_GT(coarse.depth / fine.depth, 5) << name;
  };
  const auto check = [&](const char* name, const Placed& first, const auto& path) {
    expect_smooth(name, first, path);
    const Overlap end = overlap_of(first, path(1));
    EXPECT_EQ(end.chord, 0) << name;
    EXPECT_GT(end.ny, 0.99) << name;
  };
  const Outline triangle = {{0, 0.5}, {-0.4, -0.4}, {0.5, -0.3}};
  check("triangle", large, into(Placed(centred_outline(triangle), 0.3, 0, 0.1)));
  check("tilted box", large, into(Placed(box(0.8, 0.6), -0.7, 0, 0.02)));
  check("flush box", large, into(Placed(box(0.8, 0.6), -0.7, 0)));
  check("disk", large, into(Placed::disk(0.4, 0.5, 0)));
  check("heptagon into a disk", Placed::disk(3, 0, -1),
        into(Placed(regular(7, 0.4, 0.3), 0.02, 0)));
  check("disk into a disk", Placed::disk(3, 0, -1), into(Placed::disk(0.4, 0.02, 0)));

  // A bar slides over another's end until they cross, where the chord is 0.
  const Placed bar(box(4, 0.5), 0, 0);
  const auto across = [](double t) { return Placed(box(0.4, 4), 2.15 - 0.5 * t, 0.3, 0.1); };
  EXPECT_GT(overlap_of(bar, across(0)).chord, 0.4);
  EXPECT_LT(overlap_of(bar, across(1)).chord, 1e-9);
  expect_smooth("bar over a bar's end", bar, across);
  // A wedge through a bar: its chord pushes it down, least penetration in the end up.
  const Outline wedge = {{-0.28, -2}, {0.28, -2}, {0.1, 2}, {-0.1, 2}};
  const Overlap low = overlap_of(bar, Placed(wedge, 0.1, 0.2)),
                high = overlap_of(bar, Placed(wedge, 0.1, 0.9));
  EXPECT_LT(low.ny * high.ny, 0);
  expect_smooth("wedge through a bar", bar,
                [&](double t) { return Placed(wedge, 0.1, 0.2 + 0.7 * t); });
  // The same into a half plane, whose normal does not turn.
  const auto into_half_plane = [](const char* name, const Placed& grain) {
    const auto jump = [&](int steps) {
      double largest = 0;
      std::array<double, 4> before{};
      for (int k = 0; k <= steps; ++k) {
        const Placed placed = grain.moved(0, 0.3 - 1.0 * k / steps);
        Overlap o;
        EXPECT_TRUE(overlap_with_half_plane(placed.shape(), 0, 0, 0, 1, o));
        const auto s = contact_point(placed, o);
        const std::array<double, 4> now = {s[0], s[1], o.chord, o.length};
        for (std::size_t m = 0; m < now.size() && k > 0; ++m) {
          largest = std::max(largest, std::fabs(now[m] - before[m]));
        }
        before = now;
        if (k == steps) {
          EXPECT_EQ(o.chord, 0) << name;
          EXPECT_NEAR(s[0], placed.cx(), 1e-12) << name;
          EXPECT_NEAR(s[1], placed.cy(), 1e-12) << name;
        }
      }
      return largest;
    };
    EXPECT_GT(jump(4000) / jump(32000), 5) << name;
  };
  into_half_plane("triangle", Placed(centred_outline(triangle), 0.3, 0, 0.03));
  into_half_plane("tilted box", Placed(box(0.8, 0.6), 0.3, 0, 0.03));
  into_half_plane("flush box", Placed(box(0.8, 0.62), 0.3, 0));
  into_half_plane("nonagon", Placed(regular(9, 0.4), 0.3, 0, 0.03));
  into_half_plane("disk", Placed::disk(0.4, 0.3, 0));
}

// Between chord and least penetration everything is a mixture of what is known at either end.
TEST(PolygonContinuity, MixtureNearlyInsideInClosedForm) {
  const double r = 0.4;
  const Placed large(box(6, 4), 0, 0);
  for (const double out : {0.001, 0.005, 0.01, 0.015}) {  // of the disk's area
    const double area = std::numbers::pi * r * r;
    double low = 0, high = r;  // how far the disk protrudes
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high), arm = r - middle;
      (r * r * std::acos(arm / r) - arm * std::sqrt(r * r - arm * arm) < out * area ? low : high) =
          middle;
    }
    const double arm = r - low, half = std::sqrt(r * r - arm * arm), y = 2 - arm;
    const Placed disk = Placed::disk(r, 0.5, y);
    const Overlap o = overlap_of(large, disk);
    const double share = out / 0.02, weight = share * share * (3 - 2 * share);
    // The centre of area of the disk without its segment of first moment 2/3 half^3.
    const double middle = y - 2.0 / 3 * half * half * half / (area * (1 - out));
    const auto s = contact_point(large, o);
    EXPECT_NEAR(s[0], 0.5, 1e-12);
    EXPECT_NEAR(s[1], middle + weight * (2 - middle), 1e-9) << out;
    EXPECT_NEAR(o.chord, weight * 2 * half, 1e-9) << out;
    EXPECT_NEAR(o.ny, 1, 1e-15);
    EXPECT_NEAR(o.depth, 2 * r - low, 1e-9) << out;
  }
}

// The same for polygons, from the lines themselves: chord and contact point by the pieces of B's
// outline in A, least penetration among the normals of all edges, the middle of the clipped region.
struct Mixture {
  double weight = 1, nx = 0, ny = 0, depth = 0, chord = 0, sx = 0, sy = 0;
  int crossings = 0;
};
Mixture mixture_in_long_double(const Outline& a, const Outline& b) {
  using Point = std::array<long double, 2>;
  const auto point = [](const Outline& outline, std::size_t k) {
    const auto& p = outline[k % outline.size()];
    return Point{p[0], p[1]};
  };
  Mixture mixture;
  // Every edge of B between the lines of A's edges.
  std::vector<std::array<Point, 2>> pieces;
  for (std::size_t k = 0; k < b.size(); ++k) {
    const Point p = point(b, k), q = point(b, k + 1);
    long double from = 0, to = 1;
    for (std::size_t m = 0; m < a.size(); ++m) {
      const Point u = point(a, m), v = point(a, m + 1);
      const auto outside = [&](const Point& x) {
        return (v[1] - u[1]) * (x[0] - u[0]) - (v[0] - u[0]) * (x[1] - u[1]);
      };
      const long double dp = outside(p), dq = outside(q);
      if (dp > 0 && dq > 0) to = -1;
      if (dp > 0 && dq <= 0) from = std::max(from, dp / (dp - dq));
      if (dp <= 0 && dq > 0) to = std::min(to, dp / (dp - dq));
    }
    if (from >= to) continue;
    const auto at = [&](long double t) {
      return Point{p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])};
    };
    mixture.crossings += (from > 0) + (to < 1);
    pieces.push_back({at(from), at(to)});
  }
  // From where B's outline leaves A to where it enters: the chord, and the middle of its ends.
  long double bx = 0, by = 0;
  for (const auto& [p, q] : pieces) {
    bx -= q[0] - p[0];
    by -= q[1] - p[1];
  }
  const long double chord = std::hypot(bx, by), tx = bx / chord, ty = by / chord;
  long double along_t = 0, along_n = 0;
  for (const auto& [p, q] : pieces) {
    along_t -= (q[0] * q[0] + q[1] * q[1] - p[0] * p[0] - p[1] * p[1]) / (2 * chord);
    for (const auto& [x, sign] : {std::pair{q, -1}, std::pair{p, 1}}) {
      along_n += sign * (x[0] * tx + x[1] * ty) * (x[0] * ty - x[1] * tx) / chord;
    }
  }
  // Middle and extent of the region.
  const LongLoop loop = overlap_in_long_double(a, b);
  long double area = 0, mx = 0, my = 0, low = INFINITY, high = -INFINITY;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Point &p = loop[k], &q = loop[(k + 1) % loop.size()];
    const long double cross = p[0] * q[1] - q[0] * p[1];
    area += cross / 2;
    mx += cross * (p[0] + q[0]) / 6;
    my += cross * (p[1] + q[1]) / 6;
    low = std::min(low, p[0] * ty - p[1] * tx);
    high = std::max(high, p[0] * ty - p[1] * tx);
  }
  // Least penetration: how far the one reaches into the other along every edge's normal.
  long double least = INFINITY, ux = 0, uy = 0;
  for (const double sign : {1.0, -1.0}) {
    const Outline &own = sign > 0 ? a : b, &other = sign > 0 ? b : a;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const Point p = point(own, k), q = point(own, k + 1);
      const long double length = std::hypot(q[0] - p[0], q[1] - p[1]);
      const long double x = (q[1] - p[1]) / length, y = -(q[0] - p[0]) / length;
      long double into = -INFINITY;
      for (const auto& corner : other) {
        into = std::max(into, (p[0] - corner[0]) * x + (p[1] - corner[1]) * y);
      }
      if (into >= least) continue;
      least = into;
      ux = sign * x;
      uy = sign * y;
    }
  }
  const auto smooth = [](long double share) {
    const long double s = std::clamp(share, 0.0L, 1.0L);
    return s * s * (3 - 2 * s);
  };
  const long double smaller = std::min(area_of(a), area_of(b));
  const long double w =
      smooth((smaller - area) / (0.02L * smaller)) * smooth(chord * chord / (0.02L * area));
  const long double nx = w * ty + (1 - w) * ux, ny = -w * tx + (1 - w) * uy,
                    size = std::hypot(nx, ny);
  mixture.weight = static_cast<double>(w);
  mixture.nx = static_cast<double>(nx / size);
  mixture.ny = static_cast<double>(ny / size);
  mixture.depth = static_cast<double>(w * (high - low) + (1 - w) * least);
  mixture.chord = static_cast<double>(w * size * chord);
  mixture.sx = static_cast<double>(w * (along_t * tx + along_n * ty) + (1 - w) * mx / area);
  mixture.sy = static_cast<double>(w * (along_t * ty - along_n * tx) + (1 - w) * my / area);
  return mixture;
}

TEST(PolygonContinuity, MixtureOfPolygonsByBruteForce) {
  Random random(21);
  int mixed = 0, pure = 0;
  for (int k = 0; k < 4000; ++k) {
    const double ratio = random.uniform(0.1, 0.6);
    const Placed a(random_outline(random, 3 + k % 7, 1, random.uniform(1, 2)), 0, 0);
    const Placed whole(random_outline(random, 3 + k % 5, ratio, random.uniform(1, 2)), 0, 0);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const auto at = [&](double distance) {
      return whole.moved(distance * std::cos(angle), distance * std::sin(angle));
    };
    // As far out as leaves so much of the smaller outline's area outside.
    const double smaller = std::min(a.area(), whole.area()), out = random.uniform(0, 0.03);
    double low = 0, high = 2;
    for (int m = 0; m < 60; ++m) {
      const double middle = 0.5 * (low + high);
      (overlap_of(a, at(middle)).area > (1 - out) * smaller ? low : high) = middle;
    }
    const Placed b = at(low);
    const Mixture expected = mixture_in_long_double(a.corners(), b.corners());
    if (expected.crossings != 2) continue;  // with more the sums are held back by the region
    ++(expected.weight < 1 ? mixed : pure);
    const Overlap o = overlap_of(a, b);
    const auto s = contact_point(a, o);
    ASSERT_NEAR(o.nx, expected.nx, 1e-9) << k;
    ASSERT_NEAR(o.ny, expected.ny, 1e-9) << k;
    ASSERT_NEAR(o.depth, expected.depth, 1e-9) << k;
    ASSERT_NEAR(o.chord, expected.chord, 1e-9) << k;
    ASSERT_NEAR(s[0], expected.sx, 1e-9) << k;
    ASSERT_NEAR(s[1], expected.sy, 1e-9) << k;
  }
  EXPECT_GT(mixed, 1000);
  EXPECT_GT(pure, 500);
}

}  // namespace
}  // namespace grainfield::dem
