// Disks with polygons and half planes against the textbook formula by sectors and triangles.
#include <gmock/gmock.h>

#include <cstring>

#include "tests/dem/polygon_scene.h"

namespace grainfield::dem {
namespace {

// Area common to a disk about the origin and the triangle (0, p, q), signed: parts of the edge
// inside the circle give triangles, parts outside give sectors.
long double wedge(long double px, long double py, long double qx, long double qy, long double r) {
  const auto sector = [&](long double ax, long double ay, long double bx, long double by) {
    return r * r / 2 * std::atan2(ax * by - ay * bx, ax * bx + ay * by);
  };
  const long double ex = qx - px, ey = qy - py, e2 = ex * ex + ey * ey;
  const long double foot = -(px * ex + py * ey) / e2, cross = px * ey - py * ex;
  const long double under = r * r * e2 - cross * cross;
  if (under <= 0) return sector(px, py, qx, qy);
  const long double half = std::sqrt(under) / e2;
  const long double t0 = std::clamp(foot - half, 0.0L, 1.0L);
  const long double t1 = std::clamp(foot + half, 0.0L, 1.0L);
  if (!(t0 < t1)) return sector(px, py, qx, qy);
  const long double ax = px + t0 * ex, ay = py + t0 * ey, bx = px + t1 * ex, by = py + t1 * ey;
  return sector(px, py, ax, ay) + (ax * by - ay * bx) / 2 + sector(bx, by, qx, qy);
}

double sector_area(const Placed& disk, const Placed& polygon) {
  long double area = 0;
  const Outline c = polygon.corners();
  for (std::size_t k = 0; k < c.size(); ++k) {
    const auto &p = c[k], &q = c[(k + 1) % c.size()];
    area += wedge(static_cast<long double>(p[0]) - disk.cx(),
                  static_cast<long double>(p[1]) - disk.cy(),
                  static_cast<long double>(q[0]) - disk.cx(),
                  static_cast<long double>(q[1]) - disk.cy(), disk.radius());
  }
  return static_cast<double>(area);
}

std::pair<Placed, Placed> disk_pair(Random& random, int kind) {
  const double ratio = kind % 3 == 0 ? 1 : 2 + 3 * random.uniform();
  const Placed polygon(random_outline(random, 3 + kind % 12, 1, ratio), 0, 0);
  const double radius =
      kind % 4 == 0 ? std::pow(10, random.uniform(-2, 2)) : random.uniform(0.3, 1.5);
  const double place = random.uniform(0, 7), reach = radius + polygon.radius();
  const auto disk = [&](double distance) {
    return Placed::disk(radius, distance * std::cos(place), distance * std::sin(place));
  };
  double distance = random.uniform(0, 1) * reach;
  if (kind % 5 == 1) {
    double touching = 0, apart = reach;
    for (int k = 0; k < 60; ++k) {
      const double middle = (touching + apart) / 2;
      (overlap_of(disk(middle), polygon).area > 0 ? touching : apart) = middle;
    }
    distance = touching - std::pow(10, random.uniform(-8, -2)) * radius;
  }
  return {disk(distance), polygon};
}

TEST(DiskPolygon, AreaAgainstSectors) {
  Random random(1);
  int found = 0, light = 0;
  for (int k = 0; k < 30000; ++k) {
    const auto [disk, polygon] = disk_pair(random, k);
    const Overlap o = overlap_of(disk, polygon);
    const double expected = sector_area(disk, polygon), r2 = disk.radius() * disk.radius();
    // The sectors cancel to 1e-19 r^2; our crossings are right to 1e-16 of both sizes.
    ASSERT_NEAR(o.area, expected, 1e-14 * (r2 + 1)) << k;
    ASSERT_NEAR(overlap_of(polygon, disk).area, o.area, 1e-15 * (r2 + 1)) << k;
    found += o.area > 0;
    light += o.area > 0 && o.area < 1e-6 * r2;
  }
  EXPECT_GT(found, 15000);
  EXPECT_GT(light, 1000);
}

TEST(DiskPolygon, SectorsAgainstAPolygonOfManyCorners) {
  Random random(2);
  for (int k = 0; k < 30; ++k) {
    const auto [disk, polygon] = disk_pair(random, 1 + 4 * k);
    const Placed fine(regular(4000, disk.radius()), disk.cx(), disk.cy());
    // A regular n-gon lacks (2 pi / n)^2 / 6 of its circle's area.
    EXPECT_NEAR(overlap_of(disk, polygon).area,
                area_in_long_double(fine.corners(), polygon.corners()), 2e-6);
  }
}

TEST(DiskPolygon, AreaChangesByChordTimesNormalAndByTheTorque) {
  Random random(3);
  int checked = 0;
  for (int k = 0; k < 6000; ++k) {
    auto [a, b] = disk_pair(random, k);
    if (k % 2 == 1) std::swap(a, b);
    const Overlap o = overlap_of(a, b);
    if (!(o.chord > 1e-2) || o.area < 1e-4 || a.radius() > 3 || b.radius() > 3) continue;
    if (handed_over(a, b, o.area, o.chord)) continue;
    const double h = 1e-6;
    const auto slope = [&](double ux, double uy, double angle, double px, double py) {
      return (overlap_of(a, b.moved(h * ux, h * uy, h * angle, px, py)).area -
              overlap_of(a, b.moved(-h * ux, -h * uy, -h * angle, px, py)).area) /
             (2 * h);
    };
    // Where the circle meets a side at a small angle the second derivative is large: 1e-3.
    ASSERT_NEAR(slope(1, 0, 0, 0, 0), -o.chord * o.nx, 1e-3) << k;
    ASSERT_NEAR(slope(0, 1, 0, 0, 0), -o.chord * o.ny, 1e-3) << k;
    // A disk feels no torque from forces without friction: the normal passes through its centre,
    // unless many crossings put the point outside the overlap.
    const double disk_shift = k % 2 == 0 ? o.shift_i : o.shift_j;
    if (std::fabs(disk_shift) < 1e-9) {
      ++checked;
      ASSERT_NEAR(slope(0, 0, 1, a.cx(), a.cy()), o.chord * o.shift_i, 2e-3) << k;
      ASSERT_NEAR(slope(0, 0, 1, b.cx(), b.cy()), o.chord * o.shift_j, 2e-3) << k;
    }
  }
  EXPECT_GT(checked, 1500);
}

TEST(DiskPolygon, MemorySwapAndFrame) {
  Random random(4);
  for (int k = 0; k < 6000; ++k) {
    const auto [a, b] = disk_pair(random, k);
    Overlap fresh, o;
    PairFeature empty;
    const bool found = overlap_of_shapes(a.shape(), b.shape(), empty, fresh);
    for (int m = 0; m < 20; ++m) {
      PairFeature feature{m < 16 ? m : static_cast<std::int32_t>(random.bits())};
      ASSERT_EQ(overlap_of_shapes(a.shape(), b.shape(), feature, o), found);
      if (found) {
        ASSERT_EQ(std::memcmp(&o, &fresh, sizeof o), 0);
      }
    }
    if (!found || fresh.area < 1e-9) continue;
    o = fresh;
    const Overlap w = overlap_of(b, a), f = overlap_of(a.moved(1, 2, 0.7), b.moved(1, 2, 0.7));
    const double scale = 1 + a.radius();
    ASSERT_NEAR(o.chord * o.nx, -w.chord * w.nx, 1e-10 * scale) << k;
    ASSERT_NEAR(o.lever_i, w.lever_j, 1e-8 * scale) << k;
    ASSERT_NEAR(o.depth, w.depth, 1e-8 * scale) << k;
    ASSERT_NEAR(o.chord, f.chord, 1e-7 * scale) << k;
    ASSERT_NEAR(o.depth, f.depth, 1e-6 * scale) << k;
    ASSERT_NEAR(o.lever_j, f.lever_j, 1e-6 * scale) << k;
    ASSERT_TRUE(o.depth > 0 && o.length > 0 && std::isfinite(o.shift_j)) << k;
    ASSERT_NEAR(std::hypot(o.nx, o.ny), 1, 1e-12) << k;
  }
}

TEST(DiskPolygon, SpecialPlaces) {
  const Placed square(box(2, 2), 0, 0);
  EXPECT_EQ(overlap_of(Placed::disk(1, 2, 0), square).area, 0);  // touches an edge
  EXPECT_EQ(overlap_of(Placed::disk(5, 4, 5), square).area, 0);  // touches a corner: 3-4-5
  EXPECT_EQ(overlap_of(Placed::disk(1, 9, 0), square).area, 0);
  // On an edge, as on a half plane.
  Overlap o = overlap_of(Placed::disk(0.5, 0.2, 1.4), square), plane;
  ASSERT_TRUE(overlap_with_half_plane(Placed::disk(0.5, 0.2, 1.4).shape(), 0, 1, 0, 1, plane));
  EXPECT_NEAR(o.area, plane.area, 1e-14);
  EXPECT_NEAR(o.chord, plane.chord, 1e-14);
  EXPECT_NEAR(o.depth, 0.1, 1e-15);
  EXPECT_NEAR(plane.depth, 0.1, 1e-15);
  EXPECT_NEAR(o.ny, -1, 1e-14);
  EXPECT_NEAR(o.lever_i, 0.4, 1e-14);
  EXPECT_NEAR(o.shift_j, 0.2, 1e-14);
  // Inside, touching one side from within, and protruding by less than round-off.
  for (const double x : {0.0, 0.5, std::nextafter(0.5, 1)}) {
    o = overlap_of(Placed::disk(0.5, x, 0), square);
    EXPECT_NEAR(o.area, std::numbers::pi / 4, 1e-14) << x;
    EXPECT_NEAR(o.depth, x > 0 ? 1.0 : 1.5, 1e-14) << x;
  }
  // A box inside a disk; the disk through the box's corners.
  o = overlap_of(Placed::disk(3, 0.1, 0), square);
  EXPECT_NEAR(o.area, 4, 1e-15);
  EXPECT_NEAR(o.nx, -1, 1e-15);
  EXPECT_NEAR(o.depth, 3 + 1 - 0.1, 1e-14);
  o = overlap_of(Placed::disk(std::sqrt(2.0), 0, 0), square);
  EXPECT_NEAR(o.area, 4, 1e-13);
  // A disk that looks out of all four sides: no force direction from the area.
  o = overlap_of(Placed::disk(1.1, 0, 0), square);
  EXPECT_NEAR(o.area, sector_area(Placed::disk(1.1, 0, 0), square), 1e-14);
  EXPECT_EQ(o.chord, 0);
  EXPECT_TRUE(o.depth > 0 && o.length > 0);
}

TEST(DiskPolygon, TwoDisksAsInDiskHeader) {
  const Placed a = Placed::disk(1, 0.5, 0.5), b = Placed::disk(0.4, 1.5, 1.1);
  Overlap o = overlap_of(a, b), d;
  ASSERT_TRUE(overlap_of_disks<true>(1.0, 0.6, 1, 0.4, d));
  EXPECT_NEAR(o.area, d.area, 1e-15);
  EXPECT_NEAR(o.lever_i, d.arm_i, 1e-15);
  EXPECT_NEAR(o.lever_j, d.arm_j, 1e-15);
  EXPECT_EQ(o.shift_i, 0);
  o = overlap_of(a, Placed::disk(0.2, 0.5, 0.7));  // inside: s is the small one's centre
  EXPECT_NEAR(o.lever_i, 0.2, 1e-15);
  EXPECT_NEAR(o.lever_j, 0, 1e-15);
  EXPECT_EQ(overlap_of(a, Placed::disk(1, 3, 0.5)).area, 0);
}

}  // namespace
}  // namespace grainfield::dem
