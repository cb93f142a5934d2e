// How far grains in space reach: closed forms, and the surface itself.
#include "dem/grains/reach.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "dem/grains/layer_3d.h"
#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

Grain superellipsoid_at(const Vec3& at, const Vec3& axes, const std::array<double, 2>& exponents,
                        const Eigen::Quaterniond& turned) {
  Grain g;
  g.position = at;
  g.axes = axes;
  g.exponents = exponents;
  g.radius = axes.norm();  // that of a ball about it
  g.orientation = {turned.w(), turned.x(), turned.y(), turned.z()};
  return g;
}

Eigen::Quaterniond any_turn(Random& random) {
  return Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                            random.uniform(-1, 1))
      .normalized();
}

TEST(Reach, OfSpheresAndEllipsoidsIsTheClosedForm) {
  Grain sphere;
  sphere.position = Vec3(1, 2, 3);
  sphere.radius = 0.5;
  EXPECT_DOUBLE_EQ(top_3d(sphere), 3.5);
  EXPECT_DOUBLE_EQ(bottom_3d(sphere), 2.5);
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    const Vec3 axes(random.uniform(0.5, 2), random.uniform(0.5, 2), random.uniform(0.5, 2));
    const Eigen::Quaterniond turned = any_turn(random);
    const Grain g = superellipsoid_at({0, 0, 3}, axes, {1, 1}, turned);
    const Eigen::Vector3d up = turned.conjugate() * Eigen::Vector3d::UnitZ();
    const double expected = up.cwiseProduct(Eigen::Vector3d(axes)).norm();
    EXPECT_NEAR(top_3d(g), 3 + expected, 1e-12);
    EXPECT_NEAR(bottom_3d(g), 3 - expected, 1e-12);
  }
}

// Nothing of the surface is higher than the top, and some of it nearly as high.
TEST(Reach, OfSuperellipsoidsIsTheHighestPointOfTheSurface) {
  Random random(7);
  const auto power = [](double x, double e) { return std::copysign(std::pow(std::fabs(x), e), x); };
  for (int k = 0; k < 20; ++k) {
    const Vec3 r(random.uniform(0.5, 2), random.uniform(0.5, 2), random.uniform(0.5, 2));
    const std::array<double, 2> e{random.uniform(0.4, 1.5), random.uniform(0.4, 1.5)};
    const Eigen::Quaterniond turned = any_turn(random);
    const Grain g = superellipsoid_at({0, 0, 0}, r, e, turned);
    double highest = -1;
    constexpr int kSteps = 400;
    for (int i = 0; i <= kSteps; ++i) {
      const double v = std::numbers::pi * (static_cast<double>(i) / kSteps - 0.5);
      for (int j = 0; j < 2 * kSteps; ++j) {
        const double w = std::numbers::pi * j / kSteps;
        const Eigen::Vector3d x(r.x() * power(std::cos(v), e[1]) * power(std::cos(w), e[0]),
                                r.y() * power(std::cos(v), e[1]) * power(std::sin(w), e[0]),
                                r.z() * power(std::sin(v), e[1]));
        highest = std::max(highest, (turned * x).z());
      }
    }
    EXPECT_LE(highest, top_3d(g) + 1e-9);
    EXPECT_GT(highest, 0.985 * top_3d(g));
  }
}

// Flat ellipsoids side by side: a layer as high as they are thick, not as wide.
TEST(Reach, ALayerOfFlatGrainsIsAsHighAsTheyAreThick) {
  PackingSetup packing;
  packing.dim = 3;
  packing.kind = "random";
  packing.sizes = "uniform";
  packing.width = 8;
  Snapshot s;
  s.dim = 3;
  for (int k = 0; k < 16; ++k) {
    const Vec3 at(2 * (k % 4) - 3, 2 * (k / 4) - 3, 0.2);
    Grain g = superellipsoid_at(at, {1, 1, 0.2}, {1, 1}, Eigen::Quaterniond::Identity());
    g.radius = 1;
    s.grains.push_back(g);
  }
  EXPECT_NEAR(surface_3d(s, packing), 0.4, 1e-12);
}

}  // namespace
}  // namespace grainfield::dem
