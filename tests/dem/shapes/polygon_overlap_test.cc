// What the contact of two polygons must obey: the area's derivatives, symmetry, memory.
#include <gmock/gmock.h>

#include <cstring>

#include "tests/dem/polygon_scene.h"

namespace grainfield::dem {
namespace {

bool same_bits(const Overlap& p, const Overlap& q) {
  static_assert(sizeof(Overlap) % sizeof(double) == 0);
  return std::memcmp(&p, &q, sizeof(Overlap)) == 0;
}

void expect_sound(const Overlap& o, const std::string& which) {
  for (double v : {o.nx, o.ny, o.depth, o.area, o.chord, o.arm_i, o.arm_j, o.length, o.lever_i,
                   o.lever_j, o.shift_i, o.shift_j}) {
    ASSERT_TRUE(std::isfinite(v)) << which;
  }
  ASSERT_NEAR(std::hypot(o.nx, o.ny), 1, 1e-12) << which;
  ASSERT_GT(o.depth, 0) << which;
  ASSERT_GT(o.area, 0) << which;
  ASSERT_GE(o.chord, 0) << which;
  ASSERT_GT(o.length, 0) << which;
}

// True when the contact point sits on the border of the overlap's extents along t.
bool held_back(const Placed& a, const Placed& b, const Overlap& o) {
  const auto s = contact_point(a, o);
  double low = INFINITY, high = -INFINITY;
  for (const auto& p : overlap_in_long_double(a.corners(), b.corners())) {
    const double t =
        static_cast<double>(p[1] - s[1]) * o.nx - static_cast<double>(p[0] - s[0]) * o.ny;
    low = std::min(low, t);
    high = std::max(high, t);
  }
  return low > -1e-9 || high < 1e-9;
}

TEST(PolygonOverlap, AreaChangesByChordTimesNormalAndByTheTorque) {
  Random random(1);
  int checked = 0, turned = 0, rough = 0;
  for (int k = 0; k < 12000; ++k) {
    const auto [a, b] = random_pair(random, k);
    const Overlap o = overlap_of(a, b);
    if (!(o.chord > 1e-3) || handed_over(a, b, o.area, o.chord)) continue;
    const double h = 1e-7;
    const auto slope = [&](double ux, double uy, double angle, double px, double py) {
      return (overlap_of(a, b.moved(h * ux, h * uy, h * angle, px, py)).area -
              overlap_of(a, b.moved(-h * ux, -h * uy, -h * angle, px, py)).area) /
             (2 * h);
    };
    double worst = std::fabs(slope(1, 0, 0, 0, 0) + o.chord * o.nx);
    worst = std::max(worst, std::fabs(slope(0, 1, 0, 0, 0) + o.chord * o.ny));
    if (!held_back(a, b, o)) {
      ++turned;
      worst = std::max(worst, std::fabs(slope(0, 0, 1, a.cx(), a.cy()) - o.chord * o.shift_i));
      worst = std::max(worst, std::fabs(slope(0, 0, 1, b.cx(), b.cy()) - o.chord * o.shift_j));
      worst = std::max(
          worst, std::fabs(slope(0, 0, 1, 0.3, -0.2) -
                           o.chord * (o.shift_i + (a.cx() - 0.3) * -o.ny + (a.cy() + 0.2) * o.nx)));
    }
    ++checked;
    // Difference quotients: round-off 1e-16 / h = 1e-9, and h times the area's second derivative,
    // which is the cotangent of the angle between crossing sides.
    if (worst > 1e-5) ++rough;
    ASSERT_LT(worst, 1e-3) << "pair " << k;
  }
  EXPECT_GT(checked, 5000);
  EXPECT_GT(turned, 0.95 * checked);
  EXPECT_LT(rough, 0.01 * checked);
}

TEST(PolygonOverlap, ActionAndReactionHaveNoTorqueTogether) {
  Random random(2);
  for (int k = 0; k < 12000; ++k) {
    const auto [a, b] = random_pair(random, k);
    const Overlap o = overlap_of(a, b);
    if (!(o.area > 0)) continue;
    expect_sound(o, "pair " + std::to_string(k));
    // A force (normal, tangential) on b and its opposite on a.
    const double normal = random.uniform(-1, 1), tangential = random.uniform(-1, 1);
    const double tx = -o.ny, ty = o.nx;
    const double fx = normal * o.nx + tangential * tx, fy = normal * o.ny + tangential * ty;
    const double torque_i = -(o.lever_i * tangential - o.shift_i * normal);
    const double torque_j = -o.lever_j * tangential - o.shift_j * normal;
    const double dx = b.cx() - a.cx(), dy = b.cy() - a.cy();
    ASSERT_NEAR(torque_i + torque_j + dx * fy - dy * fx, 0, 1e-13) << "pair " << k;
    ASSERT_NEAR(o.arm_i, std::hypot(o.lever_i, o.shift_i), 1e-14);
    ASSERT_NEAR(o.arm_j, std::hypot(o.lever_j, o.shift_j), 1e-14);
  }
}

TEST(PolygonOverlap, SwappedIsMirroredAndTheFrameDoesNotMatter) {
  Random random(3);
  for (int k = 0; k < 12000; ++k) {
    const auto [a, b] = random_pair(random, k);
    const Overlap o = overlap_of(a, b), w = overlap_of(b, a);
    const double angle = random.uniform(-3, 3);
    const Placed c = a.moved(3, -5, angle), d = b.moved(3, -5, angle);
    const Overlap f = overlap_of(c, d);
    const double c0 = std::cos(angle), s0 = std::sin(angle);
    const std::string which = "pair " + std::to_string(k);
    // Corners about (3, -5) are rounded to 1e-15; sides that cross at a small angle enlarge it in
    // the place of the crossing, not in the area.
    ASSERT_NEAR(o.area, w.area, 1e-14) << which;
    ASSERT_NEAR(o.area, f.area, 1e-14 + 1e-14 * a.radius()) << which;
    if (o.area < 1e-9) continue;
    ASSERT_NEAR(o.chord, w.chord, 1e-9) << which;
    ASSERT_NEAR(o.chord * o.nx, -w.chord * w.nx, 1e-9) << which;
    ASSERT_NEAR(o.chord * o.ny, -w.chord * w.ny, 1e-9) << which;
    ASSERT_NEAR(o.nx, -w.nx, 1e-7) << which;
    ASSERT_NEAR(o.depth, w.depth, 1e-8) << which;
    ASSERT_NEAR(o.lever_i, w.lever_j, 1e-7) << which;
    ASSERT_NEAR(o.shift_i, -w.shift_j, 1e-7) << which;
    ASSERT_NEAR(o.length, w.length, 1e-7) << which;
    ASSERT_NEAR(o.chord, f.chord, 1e-9) << which;
    ASSERT_NEAR(c0 * o.nx - s0 * o.ny, f.nx, 1e-6) << which;
    ASSERT_NEAR(s0 * o.nx + c0 * o.ny, f.ny, 1e-6) << which;
    ASSERT_NEAR(o.depth, f.depth, 1e-7) << which;
    ASSERT_NEAR(o.lever_i, f.lever_i, 1e-6) << which;
    ASSERT_NEAR(o.shift_i, f.shift_i, 1e-6) << which;
    ASSERT_NEAR(o.length, f.length, 1e-6) << which;
  }
}

TEST(PolygonOverlap, LatticePolygonsTouchAndCoincideInEveryWay) {
  Random random(4);
  int touching = 0, overlapping = 0, inside = 0;
  for (int k = 0; k < 20000; ++k) {
    const auto shift = [&] { return std::floor(random.uniform(-5, 6)); };
    const Placed a(lattice_outline(random), 0, 0), b(lattice_outline(random), shift(), shift());
    const double exact = area_in_long_double(a.corners(), b.corners());
    Overlap o;
    PairFeature feature;
    const bool found = overlap_of_shapes(a.shape(), b.shape(), feature, o);
    const std::string which = "pair " + std::to_string(k);
    ASSERT_EQ(found, exact > 0) << which;
    if (!found) {
      ++touching;
      continue;
    }
    ++overlapping;
    inside += o.chord == 0;
    ASSERT_NEAR(o.area, exact, 2e-15 * a.area()) << which;
    expect_sound(o, which);
    const Overlap w = overlap_of(b, a);
    // (Not the chord: b jumps where sides coincide that face the same way.)
    ASSERT_NEAR(o.area, w.area, 4e-15 * a.area()) << which;
    expect_sound(w, which);
  }
  EXPECT_GT(touching, 4000);
  EXPECT_GT(overlapping, 4000);
  EXPECT_GT(inside, 200);
}

// A memory of four crossing edges, any of these polygons' or a corner further.
PairFeature any_crossings(Random& random, const Placed& a, const Placed& b) {
  const auto edge = [&](const Placed& p, int shift) {
    return static_cast<std::int32_t>(random.uniform() * (p.shape().n + 1)) << shift;
  };
  return {1 << 30 | edge(a, 0) | edge(a, 6) | edge(b, 12) | edge(b, 18)};
}

TEST(PolygonOverlap, NoBitsOfTheMemoryChangeTheResult) {
  Random random(5);
  int apart = 0, light = 0;
  for (int k = 0; k < 12000; ++k) {
    // Random pairs, and lattice pairs whose sides coincide.
    auto [a, b] = random_pair(random, k);
    if (k % 4 == 0) {
      const auto shift = [&] { return std::floor(random.uniform(-5, 6)); };
      a = Placed(lattice_outline(random), 0, 0, k % 8 == 0 ? 0.0 : 0.1);
      b = Placed(lattice_outline(random), shift(), shift(), k % 8 == 0 ? 0.0 : 0.1);
    }
    Overlap fresh, o;
    PairFeature empty;
    const bool found = overlap_of_shapes(a.shape(), b.shape(), empty, fresh);
    apart += !found;
    light += found && fresh.area < 1e-12;
    for (int m = 0; m < 70; ++m) {
      PairFeature feature{m < 34 ? m : static_cast<std::int32_t>(random.bits())};
      if (m >= 40) feature = any_crossings(random, a, b);
      if (m == 39) feature.hint = INT32_MIN;
      if (m == 38) feature.hint = -1;
      ASSERT_EQ(overlap_of_shapes(a.shape(), b.shape(), feature, o), found) << k << " hint " << m;
      if (found) {
        ASSERT_TRUE(same_bits(o, fresh)) << k << " hint " << m;
      }
      // And what it left behind.
      ASSERT_EQ(overlap_of_shapes(a.shape(), b.shape(), feature, o), found) << k << " hint " << m;
    }
  }
  EXPECT_GT(apart, 2000);
  EXPECT_GT(light, 300);
}

// Pairs within round-off of touching: the memory must not decide.
TEST(PolygonOverlap, RoundOffContactsDoNotDependOnTheMemory) {
  Random random(6);
  int found_some = 0, found_none = 0;
  for (int k = 0; k < 4000; ++k) {
    const Outline outline = regular(3 + k % 8, 1, 0.1 * (k % 5));
    const double angle = random.uniform(0, 6);
    const Placed a(outline, 0, 0, angle);
    // Mirror image in one of its edges: edge on edge, up to round-off.
    const double n = static_cast<double>(outline.size());
    const double normal = angle + 0.1 * (k % 5) + std::numbers::pi / n;
    const double distance =
        2 * std::cos(std::numbers::pi / n) * (1 + 1e-16 * random.uniform(-8, 8));
    const Placed b(outline, distance * std::cos(normal), distance * std::sin(normal),
                   angle + (outline.size() % 2 == 0 ? 0.0 : std::numbers::pi / n));
    Overlap fresh, o;
    PairFeature empty;
    const bool found = overlap_of_shapes(a.shape(), b.shape(), empty, fresh);
    (found ? found_some : found_none) += 1;
    for (int hint = 0; hint < 80; ++hint) {
      PairFeature feature = hint < 24 ? PairFeature{hint} : any_crossings(random, a, b);
      ASSERT_EQ(overlap_of_shapes(a.shape(), b.shape(), feature, o), found) << k;
      if (found) {
        ASSERT_TRUE(same_bits(o, fresh)) << k;
      }
    }
  }
  EXPECT_GT(found_some, 200);
  EXPECT_GT(found_none, 200);
}

TEST(PolygonOverlap, DegenerateConfigurations) {
  const auto none = [](const Placed& a, const Placed& b) {
    EXPECT_EQ(overlap_of(a, b).area, 0);
    EXPECT_EQ(overlap_of(b, a).area, 0);
  };
  const Placed unit(box(2, 2), 0, 0);
  none(unit, Placed(box(2, 2), 2, 0));                              // edge on edge
  none(unit, Placed(box(2, 2), 2, 1.3));                            // part of an edge on an edge
  none(unit, Placed(box(2, 2), 2, 2));                              // corner on corner
  none(unit, Placed({{1, 0}, {0, 1}, {-1, 0}, {0, -1}}, 2, 0.25));  // corner on edge
  none(unit, Placed({{1, 0}, {0, 1}, {-1, 0}, {0, -1}}, 0, 5));

  // Boxes side by side, shifted: the overlap is 0.1 x 1.5, the chord its diagonal.
  Overlap o = overlap_of(unit, Placed(box(2, 2), 1.9, 0.5));
  EXPECT_NEAR(o.area, 0.15, 1e-15);
  EXPECT_NEAR(o.chord, std::hypot(0.1, 1.5), 1e-15);
  // Flush on top of each other: the chord joins the crossings at the sides.
  o = overlap_of(unit, Placed(box(2, 2), 0, 1.9));
  EXPECT_NEAR(o.area, 0.2, 1e-15);
  EXPECT_NEAR(o.ny, 1, 1e-15);
  EXPECT_NEAR(o.depth, 0.1, 1e-15);
  EXPECT_NEAR(o.chord, 2, 1e-15);
  EXPECT_NEAR(o.shift_i, 0, 1e-15);

  // Identical: the least width separates them.
  const Placed heptagon(regular(7, 1), 0, 0);
  o = overlap_of(heptagon, heptagon);
  expect_sound(o, "identical");
  EXPECT_NEAR(o.area, heptagon.area(), 1e-14);
  EXPECT_NEAR(o.depth, 1 + std::cos(std::numbers::pi / 7), 1e-14);
  EXPECT_EQ(o.chord, 0);

  // A small one deep inside a large one, nearest to the right edge: pushed out there.
  const Placed wall(box(200, 100), 0, 0), grain(regular(6, 1), 95, 3);
  o = overlap_of(wall, grain);
  expect_sound(o, "inside");
  EXPECT_NEAR(o.area, grain.area(), 1e-12);
  EXPECT_DOUBLE_EQ(o.nx, 1);
  EXPECT_NEAR(o.depth, 100 - 95 + 1, 1e-12);
  EXPECT_NEAR(contact_point(wall, o)[0], 95, 1e-12);
  EXPECT_NEAR(contact_point(wall, o)[1], 3, 1e-12);
  o = overlap_of(grain, wall);
  EXPECT_DOUBLE_EQ(o.nx, -1);

  // Two bars that cross: no displacement changes the area; the least penetration decides.
  o = overlap_of(Placed(box(4, 0.5), 0, 0), Placed(box(0.4, 4), 0.1, 0.3));
  expect_sound(o, "bars");
  EXPECT_NEAR(o.area, 0.2, 1e-15);
  EXPECT_EQ(o.chord, 0);
  EXPECT_NEAR(std::fabs(o.ny), 1, 1e-15);
  EXPECT_NEAR(o.depth, 2 + 0.25 - 0.3, 1e-14);
}

TEST(PolygonOverlap, TooManyCornersAreRefused) {
  const Placed many(regular(65, 1), 0, 0), few(regular(5, 1), 0, 0);
  EXPECT_THROW(overlap_of(many, few), std::invalid_argument);
  EXPECT_THROW(overlap_of(few, many), std::invalid_argument);
  EXPECT_THROW(overlap_of(many, Placed::disk(1, 0, 0)), std::invalid_argument);
}

TEST(PolygonOverlap, HalfPlaneIsTheLimitOfALargeBox) {
  Random random(7);
  int found = 0, inside = 0;
  for (int k = 0; k < 5000; ++k) {
    const Placed a(random_outline(random, 3 + k % 10, 1, random.uniform(1, 3)), 0.3, 0.2);
    const double angle = random.uniform(0, 6), height = random.uniform(-1.6, 1.1);
    const double wx = -std::sin(angle), wy = std::cos(angle);
    const double px = 0.3 - height * wx, py = 0.2 - height * wy;
    // A box 400 wide and deep whose upper side lies in the plane.
    const Placed large(box(400, 400), px - 200 * wx, py - 200 * wy, angle);
    Overlap o;
    const bool is = overlap_with_half_plane(a.shape(), px, py, wx, wy, o);
    const Overlap w = overlap_of(a, large);
    ASSERT_NEAR(is ? o.area : 0.0, w.area, 1e-12) << k;
    if (!is || o.area < 1e-9) continue;
    ++found;
    EXPECT_EQ(o.nx, -wx);
    EXPECT_EQ(o.ny, -wy);
    ASSERT_NEAR(o.depth, w.depth, 1e-7) << k;
    ASSERT_NEAR(o.chord, w.chord, 1e-7) << k;
    ASSERT_NEAR(o.lever_i, w.lever_i, 1e-7) << k;
    ASSERT_NEAR(o.shift_i, w.shift_i, 1e-7) << k;
    ASSERT_NEAR(o.arm_i, w.arm_i, 1e-7) << k;
    ASSERT_GT(o.length, 0);
    inside += o.chord == 0;
  }
  EXPECT_GT(found, 3000);
  EXPECT_GT(inside, 300);
}

}  // namespace
}  // namespace grainfield::dem
