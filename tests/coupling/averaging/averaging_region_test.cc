// Where a packing is, what it shares with kernels and elements, and averages in three dimensions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "coupling/averaging/average.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/region.h"
#include "coupling/averaging/weights.h"
#include "tests/coupling/averaging_scene.h"

namespace grainfield::coupling {
namespace {

using test::layer;
using test::options;

TEST(Region, KernelShareIsItsAreaInside) {
  const dem::Snapshot s = layer(3);
  const Region region(s);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(-0.01, 0.13), y(-0.01, 0.08);
  const auto kernel = make_kernel("heaviside", 0.015);
  const Support& circle = *find_support("circle");
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector2d at(x(random), y(random));
    const double area = region.measure(circle, 0.015, at) / circle.measure(0.015, 2);
    // Chords of a disk end with square roots, which Gauss points see to a part in a thousand.
    EXPECT_NEAR(region.share(*kernel, at, false), area, 2e-3);
  }
  EXPECT_NEAR(region.share(*make_kernel("lucy", 0.005), Eigen::Vector2d(0.06, 0.03), false), 1,
              1e-5);
}

TEST(Region, HeapEndsAtItsSlopes) {
  // A triangle of disks: the region is nearly that triangle.
  dem::Snapshot s;
  const double d = 0.01;
  test::add_wall(s, "floor", {0, 0, 0}, {0, 1, 0});
  const int n = 30;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < 2 * (n - y) - 1; ++x)
      s.grains.push_back(test::disk(static_cast<std::int64_t>(s.grains.size()), (x + y) * d,
                                    (y + 0.5) * d, d / 2));
  const Region region(s);
  const Support& square = *find_support("square");
  const Eigen::Vector2d middle((n - 1) * d, n * d / 2);
  EXPECT_NEAR(region.measure(square, 1, middle), n * d * n * d, 0.05 * n * d * n * d);
}

TEST(Region, SphereInABox) {
  dem::Snapshot s;
  s.dim = 3;
  dem::Grain g = test::disk(0, 0, 0, 0.5);
  s.grains.push_back(g);
  for (int a = 0; a < 3; ++a)
    for (double side : {-1., 1.}) {
      dem::Vec3 normal(0, 0, 0);
      normal[a] = -side;
      test::add_wall(s, "wall", -2 * normal, normal);
    }
  dem::Contact touch;
  touch.j = -6;  // the last wall, above
  s.contacts.push_back(touch);
  const Region region(s);
  const Support& sphere = *find_support("circle");
  const auto inside = [&](double x, double y, double z, double r) {
    return region.measure(sphere, r, Eigen::Vector3d(x, y, z)) / sphere.measure(r, 3);
  };
  EXPECT_NEAR(inside(0, 0, 0, 1), 1, 1e-12);
  EXPECT_NEAR(inside(2, 0, 0, 1), 0.5, 1e-12);
  EXPECT_NEAR(inside(2, 2, 0, 1), 0.25, 1e-9);
  EXPECT_NEAR(inside(2, 2, -2, 1), 0.125, 1e-9);
  // A cap of height h: pi h^2 (3 r - h)/3.
  EXPECT_NEAR(inside(0, 0, 1.5, 1), 1 - 0.25 * (3 - 0.5) / 4, 1e-12);
  EXPECT_NEAR(inside(0, 0, 0, 4) * sphere.measure(4, 3), 64, 1e-9);
}

TEST(Region, ALidThatNothingTouchesIsNotTheSurface) {
  dem::Snapshot s = layer(4);
  const Region open(s);
  test::add_wall(s, "lid", {0, 1, 0}, {0, -1, 0});
  EXPECT_EQ(Region(s).highest(), open.highest());
  EXPECT_EQ(Region(s).corners().size(), open.corners().size());
  dem::Contact touch;
  touch.i = static_cast<std::int64_t>(s.grains.size()) - 1;
  touch.j = -static_cast<std::int64_t>(s.walls.size());
  s.contacts.push_back(touch);
  EXPECT_EQ(Region(s).highest(), 1);

  dem::Snapshot ball;
  ball.dim = 3;
  ball.grains.push_back(test::disk(0, 0, 0, 0.5));
  test::add_wall(ball, "lid", {0, 0, 2}, {0, 0, -1});
  EXPECT_EQ(Region(ball).highest(), 0.5);
  touch.i = 0;
  touch.j = -1;
  ball.contacts.push_back(touch);
  EXPECT_EQ(Region(ball).highest(), 2);
}

// A cubic lattice of spheres with a force on every bond of each direction.
dem::Snapshot cubic(int n, double d, const Eigen::Vector3d& pressure) {
  dem::Snapshot s;
  s.dim = 3;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        dem::Grain g;
        g.id = x + n * (y + n * z);
        g.position = d * dem::Vec3(x, y, z);
        g.radius = d / 2;
        g.volume = std::numbers::pi / 6 * d * d * d;
        g.mass = 2000 * g.volume;
        s.grains.push_back(g);
        const int step[3]{1, n, n * n}, at[3]{x, y, z};
        for (int a = 0; a < 3; ++a) {
          if (at[a] + 1 == n) continue;
          dem::Contact c;
          c.i = g.id;
          c.j = g.id + step[a];
          c.normal[a] = 1;
          c.point = g.position + c.normal * d / 2;
          c.force = -pressure[a] * d * d * c.normal;
          s.contacts.push_back(c);
        }
      }
  return s;
}

TEST(ThreeDimensions, LatticeHasItsAnalyticStress) {
  const double d = 0.01;
  const Eigen::Vector3d pressure(100, 200, 300);
  const dem::Snapshot s = cubic(9, d, pressure);
  const Eigen::MatrixXd middle = Eigen::RowVector3d(4 * d, 4 * d, 4 * d);
  // A cube of 5 x 5 x 5 whole cells.
  const Field f = average(s, middle, options("particle_centre", "square", 2.5 * d));
  EXPECT_EQ(f.find("grains")->value[0], 125);
  const char* axes[] = {"xx", "yy", "zz"};
  for (int a = 0; a < 3; ++a) {
    const std::string name = std::string("sigma_") + axes[a];
    EXPECT_NEAR(f.find(name)->value[0], -pressure[a], 1e-10 * 300);
    EXPECT_NEAR(f.find(std::string("fabric_") + axes[a])->value[0], std::numbers::pi / 3, 1e-12);
  }
  for (const char* name : {"sigma_xy", "sigma_zx", "sigma_yz", "sigma_antisymmetric_xy"})
    EXPECT_NEAR(f.find(name)->value[0], 0, 1e-10);
  EXPECT_NEAR(f.find("volume_fraction")->value[0], std::numbers::pi / 6, 1e-12);
  EXPECT_NEAR(f.find("coordination")->value[0], 6, 1e-12);
  EXPECT_EQ(f.columns[0].unit, "N/m2");
  // The kernel over one cell: mean over 4 x 4 x 4 places.
  Eigen::MatrixXd cell(64, 3);
  for (int k = 0; k < 64; ++k)
    cell.row(k) =
        d * Eigen::RowVector3d(3.5 + (k % 4) / 4., 3.5 + (k / 4 % 4) / 4., 3.5 + (k / 16) / 4.);
  const Field mean = average(s, cell, options("coarse_graining", "lucy", 1.5 * d));
  for (int a = 0; a < 3; ++a)
    EXPECT_NEAR(mean.find(std::string("sigma_") + axes[a])->value.mean(), -pressure[a], 0.5);
  EXPECT_NEAR(mean.find("volume_fraction")->value.mean(), std::numbers::pi / 6, 1e-3);
}

TEST(ThreeDimensions, BalanceOfAStackOnAFloor) {
  dem::Snapshot s;
  s.dim = 3;
  s.gravity = {0, 0, -9.81};
  test::add_wall(s, "floor", {0, 0, 0}, {0, 0, 1});
  const double d = 0.01, mass = 0.002;
  for (int k = 0; k < 4; ++k) {
    dem::Grain g;
    g.id = k;
    g.position = {0.001 * k, 0, (k + 0.5) * d};
    g.radius = d / 2;
    g.mass = mass;
    g.volume = 1e-6;
    s.grains.push_back(g);
    dem::Contact c;
    c.i = k == 0 ? 0 : k - 1;
    c.j = k == 0 ? -1 : k;
    c.point = {0, 0, k * d};
    c.normal = {0, 0, k == 0 ? -1. : 1.};
    c.force = {0, 0, (k == 0 ? 1 : -1) * 9.81 * mass * (4 - k)};
    s.contacts.push_back(c);
  }
  std::swap(s.contacts[0], s.contacts[1]);
  Eigen::MatrixXd points(27, 3);
  for (int k = 0; k < 27; ++k)
    points.row(k) << 0.004 * (k % 3 - 1) + 1e-3, 0.005 * (k / 3 % 3 - 1) + 2e-3, 0.015 * (k / 9);
  for (bool extend : {false, true}) {
    AverageOptions o = options("coarse_graining", "lucy", 0.012);
    o.extend_into_walls = extend;
    double last = 0;
    for (double step : {8e-4, 4e-4, 2e-4, 1e-4}) {
      const double now = balance_residual(s, points, o, step, 2).rms;
      if (last > 0) {
        EXPECT_NEAR(std::log2(last / now), 2, 0.2) << extend;
      }
      last = now;
    }
    EXPECT_LT(last, 1e-3);
  }
}

TEST(ThreeDimensions, KernelsIntegrateToOneAndAlongBranches) {
  for (const std::string& name : kernel_names()) {
    const auto k = make_kernel(name, 0.3, 3);
    EXPECT_EQ(k->dim(), 3);
    double total = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double r = k->range() * (i + 0.5) / n;
      total += 4 * std::numbers::pi * r * r * k->value(r) * k->range() / n;
    }
    EXPECT_NEAR(total, 1, 1e-7) << name;
    double side = 0;
    for (int i = 0; i < 2000; ++i)
      side += k->marginal(k->range() * ((i + 0.5) / 1000 - 1)) * k->range() / 1000;
    EXPECT_NEAR(side, 1, 1e-5) << name;
    EXPECT_NEAR(k->beyond(0), 0.5, 1e-9);
    const Eigen::Vector3d p(0.1, -0.05, 0.02), a(-0.2, 0.1, 0.3), b(0.5, 0.2, -0.1);
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += k->value((a + (i + 0.5) / n * (b - a) - p).norm()) / n;
    EXPECT_NEAR(branch_weight(*k, p, a, b), sum, 2e-4 * k->value(0)) << name;
  }
}

}  // namespace
}  // namespace grainfield::coupling
