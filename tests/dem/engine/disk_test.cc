// Overlap geometry against independent evaluations.
#include "dem/shapes/disk.h"

#include <gmock/gmock.h>

#include <cmath>

#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

// Textbook lens area in long double: an independent formula (cosines of the half angles).
double lens_area(double d, double r, double s) {
  const long double D = d, R = r, S = s;
  const long double a = std::acos((D * D + R * R - S * S) / (2 * D * R));
  const long double b = std::acos((D * D + S * S - R * R) / (2 * D * S));
  return static_cast<double>(R * R * (a - std::sin(2 * a) / 2) + S * S * (b - std::sin(2 * b) / 2));
}

TEST(Disk, LensAreaMatchesTheTextbookFormula) {
  Random random(1);
  for (int k = 0; k < 20000; ++k) {
    const double r = random.uniform(0.5, 1.5), s = random.uniform(0.01, 1) * r;
    const double d = random.uniform(r - s + 1e-3 * s, r + s - 1e-3 * s);
    const double angle = random.uniform(0, 6.283185307179586);
    Overlap o;
    ASSERT_TRUE(overlap_of_disks<true>(d * std::cos(angle), d * std::sin(angle), r, s, o));
    const double expected = lens_area(d, r, s);
    // The reference cancels to about 1e-19 / overlap; 1e-12 of the smaller disk is far above it.
    EXPECT_NEAR(o.area, expected, 1e-12 * s * s + 1e-11 * expected)
        << "d " << d << " r " << r << " s " << s;
    EXPECT_NEAR(o.arm_i, (d * d + r * r - s * s) / (2 * d), 1e-12);
    EXPECT_NEAR(o.arm_i + o.arm_j, d, 1e-13);
    EXPECT_NEAR(std::hypot(o.nx, o.ny), 1, 1e-14);
    EXPECT_NEAR(o.chord * o.chord / 4 + o.arm_i * o.arm_i, r * r, 1e-12);
  }
}

TEST(Disk, AreaChangesByTheChord) {
  Random random(2);
  for (int k = 0; k < 2000; ++k) {
    const double r = random.uniform(0.5, 1.5), s = random.uniform(0.5, 1.5);
    const double depth = std::pow(10, random.uniform(-6, -0.5)) * std::min(r, s);
    const double h = 1e-4 * depth, d = r + s - depth;
    Overlap o, near, far;
    overlap_of_disks<true>(d, 0, r, s, o);
    overlap_of_disks<true>(d - h, 0, r, s, near);
    overlap_of_disks<true>(d + h, 0, r, s, far);
    // Central difference: truncation (h/depth)^2 = 1e-8, round-off 1e-16 (r/depth)^1 / 1e-4.
    EXPECT_NEAR((near.area - far.area) / (2 * h), o.chord, 1e-5 * o.chord);
  }
}

// Arms that add up to the distance: else friction would make angular momentum.
TEST(Disk, OneInsideTheOtherTouchesAtTheInnerOnesCentre) {
  for (const auto& [r, s] : {std::pair(1.0, 0.3), std::pair(0.3, 1.0)}) {
    Overlap o;
    ASSERT_TRUE(overlap_of_disks<true>(0.2, 0, r, s, o));
    EXPECT_DOUBLE_EQ(o.arm_i, r > s ? 0.2 : 0);
    EXPECT_DOUBLE_EQ(o.arm_j, r > s ? 0 : 0.2);
    EXPECT_DOUBLE_EQ(o.area, std::numbers::pi * 0.09);
  }
}

TEST(Disk, SegmentFunctionIsContinuousWhereItsFormChanges) {
  const double below = segment_function(std::nextafter(0.2, 0.0)), above = segment_function(0.2);
  EXPECT_NEAR(below, above, 1e-14 * above + 3e-17);
  EXPECT_DOUBLE_EQ(segment_function(0), 0);
  EXPECT_DOUBLE_EQ(segment_function(1), std::numbers::pi / 2);
}

TEST(Disk, DeepOverlapsStayFinite) {
  Overlap o;
  ASSERT_TRUE(overlap_of_disks<true>(0, 0, 1, 0.5, o));  // same centre
  EXPECT_DOUBLE_EQ(o.area, std::numbers::pi * 0.25);
  EXPECT_TRUE(std::isfinite(o.nx) && std::isfinite(o.length) && o.length > 0);
  ASSERT_TRUE(overlap_of_disks<true>(0.3, 0, 1, 0.5, o));  // one inside the other
  EXPECT_DOUBLE_EQ(o.area, std::numbers::pi * 0.25);
  ASSERT_TRUE(overlap_of_disks<true>(0.01, 0, 1, 0.01, o));  // ratio 1:100, inside
  EXPECT_DOUBLE_EQ(o.area, std::numbers::pi * 1e-4);
  EXPECT_FALSE(overlap_of_disks<true>(2, 0, 1, 1, o));  // touching is not overlapping
  // Just before and just after full containment the area agrees.
  Overlap in, out;
  overlap_of_disks<true>(0.5 - 1e-9, 0, 1, 0.5, in);
  overlap_of_disks<true>(0.5 + 1e-9, 0, 1, 0.5, out);
  EXPECT_NEAR(in.area, out.area, 1e-8);
}

TEST(Disk, OverlapWithAPlane) {
  Random random(3);
  for (int k = 0; k < 2000; ++k) {
    const double r = random.uniform(0.1, 2), h = random.uniform(-0.99, 0.99) * r;
    Overlap o;
    ASSERT_TRUE(overlap_with_plane<true>(h, r, 0, 1, o));
    EXPECT_NEAR(o.area, r * r * std::acos(h / r) - h * std::sqrt(r * r - h * h),
                3e-12 * r * r);  // acos near +-1 loses digits
    EXPECT_EQ(o.ny, -1);
    EXPECT_DOUBLE_EQ(o.depth, r - h);
  }
  Overlap o;
  EXPECT_FALSE(overlap_with_plane<true>(1, 1, 0, 1, o));
  ASSERT_TRUE(overlap_with_plane<true>(-3, 1, 0, 1, o));  // centre far behind the wall
  EXPECT_DOUBLE_EQ(o.area, std::numbers::pi);
}

}  // namespace
}  // namespace grainfield::dem
