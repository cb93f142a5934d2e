// What must come back to round-off: homogeneous stress, fabric, inertia, areas.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "coupling/averaging/average.h"
#include "coupling/averaging/clip.h"
#include "coupling/averaging/grain_facts.h"
#include "coupling/averaging/weights.h"
#include "tests/coupling/averaging_scene.h"

namespace grainfield::coupling {
namespace {

using test::options;

using Eigen::Matrix2d;
using Eigen::Vector2d;

Matrix2d stress_at(const Field& f, Eigen::Index p) {
  Matrix2d s;
  s << f.find("sigma_xx")->value[p], f.find("sigma_xy")->value[p], f.find("sigma_yx")->value[p],
      f.find("sigma_yy")->value[p];
  return s;
}

// A random packing in a box of which the walls push with the tractions of `stress`, each at the
// middle of its share of the wall; the forces inside are some equilibrium of every grain.
dem::Snapshot boxed(unsigned seed, const Matrix2d& stress) {
  const int columns = 9, rows = 7;
  const double d = 0.01, width = columns * d, height = rows * d;
  dem::Snapshot s = test::layer(seed, columns, rows);
  s.gravity.setZero();
  test::add_wall(s, "lid", {0, height, 0}, {0, -1, 0});
  std::erase_if(s.contacts, [](const dem::Contact& c) { return c.j < 0; });
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  // The wall's forces are taken as contacts with balanced partners below: fixed by solving for the
  // others alone.
  std::vector<dem::Contact> pushes;
  const auto push = [&](int wall, int n, double length, auto&& grain_of, auto&& place) {
    std::vector<double> ends{0};
    for (int k = 1; k < n; ++k) ends.push_back((k + uniform(random)) * length / n);
    ends.push_back(length);
    for (int k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const dem::Vec3 normal = s.walls[static_cast<std::size_t>(wall)].normal;
      dem::Contact c;
      c.i = grain_of(k);
      c.j = -1 - wall;
      c.point = place((ends[at] + ends[at + 1]) / 2);
      c.normal = -normal;
      c.force.head<2>() = -stress * normal.head<2>() * (ends[at + 1] - ends[at]);
      pushes.push_back(c);
    }
  };
  push(
      0, columns, width, [](int k) { return k; }, [](double t) { return dem::Vec3(t, 0, 0); });
  push(
      1, rows, height, [&](int k) { return columns * k; },
      [](double t) { return dem::Vec3(0, t, 0); });
  push(
      2, rows, height, [&](int k) { return columns * k + columns - 1; },
      [&](double t) { return dem::Vec3(width, t, 0); });
  push(
      3, columns, width, [&](int k) { return columns * (rows - 1) + k; },
      [&](double t) { return dem::Vec3(t, height, 0); });
  test::balance_forces(s, pushes);
  s.contacts.insert(s.contacts.end(), pushes.begin(), pushes.end());
  std::sort(s.contacts.begin(), s.contacts.end(),
            [](const auto& a, const auto& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  return s;
}

TEST(Exact, HomogeneousStressOfARandomPackingFromEveryWeight) {
  Matrix2d stress;
  stress << -120, 35, 35, -300;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const dem::Snapshot s = boxed(seed, stress);
    const Eigen::MatrixXd middle = line_points(0.045, 0.045, 1, 0.035);
    for (const char* method : {"particle_centre", "area_exact"})
      for (const std::string& support : support_names()) {
        const Field f = average(s, middle, options(method, support, 0.08));
        EXPECT_LT((stress_at(f, 0) - stress).norm(), 1e-11 * stress.norm()) << method << support;
        EXPECT_EQ(f.find("grains")->value[0], 63);
      }
    // One disk-shaped kernel over everything; normalised to its part inside the packing.
    AverageOptions disk = options("coarse_graining", "heaviside", 0.08);
    disk.extend_into_walls = false;
    disk.free_surface = "normalised";
    const Field f = average(s, middle, disk);
    EXPECT_LT((stress_at(f, 0) - stress).norm(), 1e-11 * stress.norm());
    // The bells: integral of the field over the plane. Sums over a grid converge as the smoothness
    // of the kernel allows: Lucy with a power above 4, the Gaussian with its step at the cut.
    const int n = 150;
    const double low = -0.05, size = 0.19, cell = size * size / n / n;
    const Eigen::MatrixXd plane =
        grid_points(low, low + size * (n - 1) / n, n, low, low + size * (n - 1) / n, n);
    for (const auto& [kernel, tolerance] :
         std::map<std::string, double>{{"lucy", 1e-6}, {"gaussian", 1e-3}}) {
      AverageOptions bell = options("coarse_graining", kernel, 0.015);
      bell.extend_into_walls = false;
      const Field field = average(s, plane, bell);
      Matrix2d sum = Matrix2d::Zero();
      for (Eigen::Index p = 0; p < plane.rows(); ++p) sum += stress_at(field, p) * cell;
      EXPECT_LT((sum / (0.09 * 0.07) - stress).norm(), tolerance * stress.norm()) << kernel;
    }
  }
}

// Quadrilaterals that fill the plane, each edge loaded by the tractions of one stress: the RVE cut
// through them sees that stress everywhere.
dem::Snapshot tiles(unsigned seed, const Matrix2d& stress, int n) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.25, 0.25);
  std::vector<Vector2d> corner;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const bool edge = x == 0 || y == 0 || x == n || y == n;
      corner.emplace_back(x + (edge ? 0 : jitter(random)), y + (edge ? 0 : jitter(random)));
    }
  dem::Snapshot s;
  for (const auto& [name, point, normal] :
       {std::tuple{"floor", dem::Vec3(0, 0, 0), dem::Vec3(0, 1, 0)},
        std::tuple{"left", dem::Vec3(0, 0, 0), dem::Vec3(1, 0, 0)},
        std::tuple{"right", dem::Vec3(n, 0, 0), dem::Vec3(-1, 0, 0)},
        std::tuple{"lid", dem::Vec3(0, n, 0), dem::Vec3(0, -1, 0)}})
    test::add_wall(s, name, point, normal);
  const auto at = [&](int x, int y) { return corner[static_cast<std::size_t>(x + (n + 1) * y)]; };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const Corners c{at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)};
      Vector2d centroid(0, 0);
      const double area = area_of(c);
      for (std::size_t k = 1; k < 3; ++k)
        centroid += area_of({c[0], c[k], c[k + 1]}) / area * (c[0] + c[k] + c[k + 1]) / 3;
      dem::Grain g;
      g.id = x + n * y;
      g.angle = 0.1 * static_cast<double>(g.id);  // outlines are in the body frame
      const Eigen::Rotation2D<double> back(-g.angle);
      for (const Vector2d& p : c) {
        const Vector2d b = back * (p - centroid);
        g.outline.push_back({b.x(), b.y()});
        g.radius = std::max(g.radius, b.norm());
      }
      g.position << centroid.x(), centroid.y(), 0;
      g.volume = area;
      g.mass = 2 * area;
      s.grains.push_back(g);
      const auto touch = [&](int other, const Vector2d& a, const Vector2d& b) {
        dem::Contact contact;
        contact.i = g.id;
        contact.j = other;
        contact.point << (a.x() + b.x()) / 2, (a.y() + b.y()) / 2, 0;
        const Vector2d out(b.y() - a.y(), a.x() - b.x());
        contact.normal.head<2>() = out.normalized();
        contact.force.head<2>() = stress * out;
        s.contacts.push_back(contact);
      };
      if (y == 0) touch(-1, c[0], c[1]);
      if (x == 0) touch(-2, c[3], c[0]);
      touch(x + 1 < n ? x + 1 + n * y : -3, c[1], c[2]);
      touch(y + 1 < n ? x + n * (y + 1) : -4, c[2], c[3]);
    }
  return s;
}

TEST(Exact, AreaExactSeesTheStressOfTilesEverywhere) {
  Matrix2d stress;
  stress << -3, 0.7, 0.7, -5;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const dem::Snapshot s = tiles(seed, stress, 12);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0, 12), size(0.3, 4);
    for (int trial = 0; trial < 300; ++trial) {
      const Eigen::MatrixXd at = line_points(place(random), 0, 1, place(random));
      for (const std::string& support : support_names()) {
        const Field f = average(s, at, options("area_exact", support, size(random)));
        ASSERT_LT((stress_at(f, 0) - stress).norm(), 1e-10 * stress.norm()) << support << at;
        ASSERT_NEAR(f.find("volume_fraction")->value[0], 1, 1e-11);
        ASSERT_NEAR(f.find("density")->value[0], 2, 1e-11);
        ASSERT_NEAR(f.find("sigma_antisymmetric")->value[0], 0, 1e-10);
      }
    }
  }
}

TEST(Exact, CellsThatTileHoldEveryGrainOnce) {
  // Squares side by side over the packing: the grains' shares add up.
  for (dem::Snapshot s : {tiles(7, Matrix2d::Identity(), 8), boxed(7, Matrix2d::Identity())}) {
    for (dem::Grain& g : s.grains)
      if (g.outline.empty()) g.radius *= 0.6;  // none reaches out of the box
    const double right = s.walls[2].point.x(), w = right / 10;
    const double top = s.walls[3].point.y();
    const int ny = static_cast<int>(std::round(top / w / 2 + 0.4));
    const Eigen::MatrixXd cells = grid_points(w, 9 * w, 5, w, (2 * ny - 1) * w, ny);
    const Field f = average(s, cells, options("area_exact", "square", w));
    const double shares = f.find("grains")->value.sum();
    EXPECT_NEAR(shares, static_cast<double>(s.grains.size()), 1e-10 * shares);
  }
}

TEST(Clip, AgreesAcrossClosedForms) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-2, 2);
  for (int trial = 0; trial < 5000; ++trial) {
    Vector2d a(uniform(random), uniform(random)), b(uniform(random), uniform(random));
    const Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b);
    const Corners box{low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    const double r = std::abs(uniform(random)) + 1e-3;
    // The disk in the box and the box in the circle are one area, by two derivations.
    EXPECT_NEAR(area_in_circle(box, r), disk_in_box(r, low, high), 1e-12);
    // Cutting a polygon in two leaves its area.
    const Corners triangle{a, b, {uniform(random), uniform(random)}};
    const Vector2d far(9, 9);
    const double cut = uniform(random);
    EXPECT_NEAR(area_in_box(triangle, -far, {cut, 9}) + area_in_box(triangle, {cut, -9}, far),
                area_of(triangle), 1e-12);
    // Along any chord.
    const Vector2d middle = (a + b) / 2;
    EXPECT_NEAR(
        area_in_circle({a, middle, triangle[2]}, r) + area_in_circle({middle, b, triangle[2]}, r),
        area_in_circle(triangle, r), 1e-12);
    // Lens: symmetric, and with a disk of many corners.
    const double d = std::abs(uniform(random)), q = std::abs(uniform(random)) + 1e-3;
    EXPECT_NEAR(disk_in_disk(d, r, q), disk_in_disk(d, q, r), 1e-12);
    EXPECT_NEAR(disk_above(r, cut) + disk_above(r, -cut), std::numbers::pi * r * r, 1e-12);
  }
  Corners round;
  for (int k = 0; k < 20000; ++k) {
    const double t = 2 * std::numbers::pi * k / 20000;
    round.emplace_back(0.4 + 0.7 * std::cos(t), 0.7 * std::sin(t));
  }
  EXPECT_NEAR(area_in_circle(round, 0.6), disk_in_disk(0.4, 0.7, 0.6), 1e-7);
}

TEST(Clip, DegenerateShapes) {
  const Corners square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  EXPECT_EQ(area_in_box(square, {1, 0}, {2, 1}), 0);  // touching along an edge
  EXPECT_EQ(area_in_box(square, {0, 0}, {1, 1}), 1);  // itself
  EXPECT_EQ(area_in_box(square, {1, 1}, {2, 2}), 0);  // corner on corner
  EXPECT_NEAR(area_in_circle(square, 1), std::numbers::pi / 4, 1e-15);
  EXPECT_NEAR(area_in_circle(square, std::sqrt(2.)), 1, 1e-15);                  // through a corner
  EXPECT_NEAR(area_in_circle({{1, -1}, {3, -1}, {3, 1}, {1, 1}}, 1), 0, 1e-15);  // touching
  EXPECT_EQ(disk_in_disk(3, 1, 2), 0);
  EXPECT_EQ(disk_in_box(1, {2, 2}, {3, 3}), 0);
  EXPECT_EQ(disk_in_box(1, {1, 1}, {0, 0}), 0);
}

TEST(Exact, TraceOfFabricIsVolumeFractionTimesCoordinationForEqualGrains) {
  dem::Snapshot s = test::layer(21, 14, 9);
  for (dem::Grain& g : s.grains) {
    g.radius = 0.005;
    g.volume = std::numbers::pi * 2.5e-5;
  }
  const Eigen::MatrixXd points = grid_points(0, 0.14, 9, 0, 0.09, 7);
  for (const Method& method : methods())
    for (const std::string& kernel : method.kernels()) {
      const Field f = average(s, points, options(method.name, kernel, 0.02));
      for (Eigen::Index p = 0; p < points.rows(); ++p) {
        const double expected =
            f.find("volume_fraction")->value[p] * f.find("coordination")->value[p];
        EXPECT_NEAR(f.find("fabric_xx")->value[p] + f.find("fabric_yy")->value[p], expected,
                    1e-12 * expected)
            << method.name << kernel;
      }
    }
}

TEST(Exact, InertiaOfRegularPolygonsAndRectangles) {
  for (int n = 3; n <= 12; ++n) {
    dem::Grain g;
    g.radius = 0.7;
    g.angle = 0.3 * n;
    for (int k = 0; k < n; ++k)
      g.outline.push_back({0.7 * std::cos(2 * std::numbers::pi * k / n),
                           0.7 * std::sin(2 * std::numbers::pi * k / n)});
    const double area = n * 0.49 * std::sin(2 * std::numbers::pi / n) / 2;
    const double moment = area * 0.49 * (2 + std::cos(2 * std::numbers::pi / n)) / 12;
    const Eigen::Matrix3d theta = inertia_of(g, 2);
    EXPECT_NEAR(theta(0, 0), moment, 1e-15);
    EXPECT_NEAR(theta(1, 1), moment, 1e-15);
    EXPECT_NEAR(theta(0, 1), 0, 1e-15);
  }
  // A rectangle of 4 x 1 turned by 30 degrees: its long axis is the axis of least inertia.
  dem::Grain bar;
  bar.outline = {{-2, -0.5}, {2, -0.5}, {2, 0.5}, {-2, 0.5}};
  bar.angle = std::numbers::pi / 6;
  const Eigen::Matrix3d theta = inertia_of(bar, 2);
  const double along = 4. / 12, across = 64. / 12, c = std::cos(bar.angle), s = std::sin(bar.angle);
  EXPECT_NEAR(theta(0, 0), c * c * along + s * s * across, 1e-14);
  EXPECT_NEAR(theta(1, 1), s * s * along + c * c * across, 1e-14);
  EXPECT_NEAR(theta(0, 1), c * s * (along - across), 1e-14);
  dem::Grain disk = test::disk(0, 0, 0, 2);
  EXPECT_NEAR(inertia_of(disk, 2)(0, 0), std::numbers::pi * 4, 1e-13);
  disk.volume = 4 * std::numbers::pi / 3 * 8;
  EXPECT_NEAR(inertia_of(disk, 3)(2, 2), 0.4 * disk.volume * 4, 1e-12);
}

TEST(Exact, InertiaFieldIsTheVolumeWeightedMean) {
  const dem::Snapshot s = tiles(3, Matrix2d::Identity(), 6);
  const Field f = average(s, line_points(3, 3, 1, 3), options("particle_centre", "square", 3));
  double expected = 0;
  for (const dem::Grain& g : s.grains) expected += g.volume * inertia_of(g, 2)(0, 1) / 36;
  EXPECT_NEAR(f.find("inertia_xy")->value[0], expected, 1e-14);
}

}  // namespace
}  // namespace grainfield::coupling
