// Derived quantities of packings with known answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "coupling/averaging/grain_facts.h"
#include "coupling/structure/base_forces.h"
#include "coupling/structure/coordination_counts.h"
#include "coupling/structure/grain_axes.h"
#include "coupling/structure/histogram.h"
#include "coupling/structure/size_factor.h"
#include "coupling/structure/tensor_axes.h"
#include "coupling/structure/yield.h"
#include "tests/coupling/structure_scene.h"

namespace grainfield::coupling {
namespace {

using test::press;
using test::turned;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
constexpr double kDegree = std::numbers::pi / 180;

// Disks of radius 1/2 on a lattice with steps a and b; every pair at distance 1 touches.
dem::Snapshot lattice(int columns, int rows, Eigen::Vector2d a, Eigen::Vector2d b) {
  dem::Snapshot s;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const Eigen::Vector2d at = c * a + r * b;
      s.grains.push_back(test::disk(c + columns * r, at.x(), at.y(), 0.5));
    }
  const auto n = static_cast<std::int64_t>(s.grains.size());
  for (std::int64_t i = 0; i < n; ++i)
    for (std::int64_t j = i + 1; j < n; ++j)
      if ((s.grains[static_cast<std::size_t>(i)].position -
           s.grains[static_cast<std::size_t>(j)].position)
              .norm() < 1.001)
        press(s, i, j, 1);
  return s;
}

TEST(TensorAxes, ComeBackFromRandomTensors) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int n = 0; n < 5000; ++n) {
    const double a = uniform(random), b = a - std::abs(uniform(random)) - 1e-6,
                 t = 89.99 * uniform(random);
    const double c = std::cos(t * kDegree), s = std::sin(t * kDegree);
    const TensorAxes axes =
        tensor_axes(a * c * c + b * s * s, a * s * s + b * c * c, (a - b) * c * s);
    ASSERT_NEAR(axes.trace(), a + b, 1e-14);
    ASSERT_NEAR(axes.deviator(), a - b, 1e-14);
    ASSERT_NEAR(axes.values[0], a, 1e-14);
    // Rounding of 1e-16 turns the axis by that over the deviator.
    ASSERT_NEAR(axes.angle_deg(), t, 1e-13 / (a - b) + 1e-12);
    ASSERT_NEAR(angle_between_axes_deg(axes.angle_deg(0), axes.angle_deg(1)), 90, 1e-9);
  }
  EXPECT_TRUE(std::isnan(tensor_axes(3, 3, 0).angle_deg()));
  EXPECT_EQ(tensor_axes(3, 3, 0).deviatoric_fraction(), 0);
  EXPECT_TRUE(std::isnan(tensor_axes(0, 0, 0).deviatoric_fraction()));
  EXPECT_EQ(tensor_axes(1, 2, 0).angle_deg(), 90);
  EXPECT_TRUE(std::isnan(tensor_axes(NAN, 2, 0).trace()));
  // 3D: one axis pressed by 3, the others by 1; the antisymmetric part does not count.
  Eigen::Matrix3d tensor = Eigen::Vector3d(-1, -3, -1).asDiagonal();
  tensor(0, 1) = 5;
  tensor(1, 0) = -5;
  const TensorAxes space = tensor_axes(tensor, 3);
  EXPECT_NEAR(space.deviator(), 2, 1e-14);
  EXPECT_NEAR(std::abs(space.axes(1, 2)), 1, 1e-14);
  EXPECT_TRUE(std::isnan(space.angle_deg()));
}

TEST(TensorAxes, AnglesBetweenAxes) {
  EXPECT_DOUBLE_EQ(angle_between_axes_deg(89, -89), 2);
  EXPECT_DOUBLE_EQ(angle_between_axes_deg(-30, 60), 90);
  EXPECT_DOUBLE_EQ(angle_between_axes_deg(10, 370), 0);
}

Field tensor_field() {
  Field field;
  field.points = Eigen::MatrixXd::Zero(3, 2);
  const auto put = [&](const char* name, double a, double b, double c) {
    field.add(name, "N/m").value = Eigen::Vector3d(a, b, c);
  };
  put("sigma_xx", -1, -2, NAN);
  put("sigma_yy", -3, -2, 1);
  put("sigma_xy", 0.5, 1, 1);
  put("sigma_yx", -0.5, 1, 1);
  put("fabric_xx", 2, 2, 1);
  put("fabric_yy", 2, 1, 1);
  put("fabric_xy", 1, 0, 0);
  return field;
}

TEST(TensorAxes, ColumnsOfAField) {
  Field field = tensor_field();
  add_tensor_columns(field, "sigma", MajorAxis::most_compressive);
  add_tensor_columns(field, "fabric", MajorAxis::largest);
  add_angle_between(field, "sigma", "fabric");
  const auto at = [&](const char* name, int k) { return field.find(name)->value[k]; };
  EXPECT_EQ(at("sigma_trace", 0), -4);
  EXPECT_EQ(at("sigma_deviator", 0), 2);
  EXPECT_EQ(at("sigma_fraction", 0), -0.5);
  EXPECT_EQ(std::abs(at("sigma_angle", 0)), 90);  // pressed along y
  EXPECT_NEAR(at("sigma_angle", 1), -45, 1e-12);  // shear: tension along 45 degrees
  EXPECT_TRUE(std::isnan(at("sigma_trace", 2)));
  EXPECT_NEAR(at("fabric_angle", 0), 45, 1e-12);
  EXPECT_NEAR(at("angle_sigma_fabric", 0), 45, 1e-12);
  EXPECT_NEAR(at("angle_sigma_fabric", 1), 45, 1e-12);
  EXPECT_TRUE(std::isnan(at("angle_sigma_fabric", 2)));
  EXPECT_EQ(field.find("sigma_deviator")->unit, "N/m");
  EXPECT_THAT(refusal_of([&] { add_tensor_columns(field, "strain", MajorAxis::largest); }),
              HasSubstr("no column strain_xx; it has: sigma_xx, "));
}

TEST(Yield, PlasticFlankIsAtTheLimit) {
  // Cantelaube's flank: (sxx, syy, sxy) ~ (sin^2 b, 1 + cos^2 b, +- sin b cos b), b = 90 - phi.
  for (double phi = 5; phi < 90; phi += 5) {
    const double s = std::cos(phi * kDegree), c = std::sin(phi * kDegree);
    for (const double sign : {-1.0, 1.0}) {
      const double xx = -7 * s * s, yy = -7 * (1 + c * c), xy = 7 * sign * s * c;
      EXPECT_NEAR(mohr_coulomb_expression(xx, yy, xy, phi), 0, 1e-12 * yy * yy);
      // The root in the angle loses half the digits near 90 degrees.
      EXPECT_NEAR(mobilised_friction_deg(xx, yy, xy), phi, 1e-6);
      EXPECT_LT(mohr_coulomb_expression(xx, yy, xy, phi + 1), 0);
    }
  }
  EXPECT_EQ(mobilised_friction_deg(-1, -1, 0), 0);
  EXPECT_EQ(mobilised_friction_deg(-1, 0.5, 0), 90);
  EXPECT_TRUE(std::isnan(mobilised_friction_deg(1, 1, 0)));
  Field field = tensor_field();
  add_yield_columns(field, 30);
  EXPECT_NEAR(field.find("mohr_coulomb")->value[0], 4.0 / 16 - 0.25, 1e-15);
  EXPECT_NEAR(field.find("mobilised_friction")->value[1], 30, 1e-12);
  EXPECT_TRUE(std::isnan(field.find("mohr_coulomb")->value[2]));
  EXPECT_THAT(refusal_of([&] { add_yield_columns(field, 90); }), HasSubstr("found 90 degrees"));
}

TEST(Fabric, OfLattices) {
  const double h = std::sqrt(3) / 2;
  const dem::Snapshot triangular = lattice(7, 7, {1, 0}, {0.5, h});
  const std::size_t middle = 24;
  const TensorAxes six = tensor_axes(grain_facts(triangular)[middle].fabric, 2);
  EXPECT_NEAR(six.trace(), 6, 1e-14);
  EXPECT_NEAR(six.deviator(), 0, 1e-14);
  // Contacts at +-30 degrees: 4 cos^2 and 4 sin^2 of it.
  dem::Snapshot four = lattice(7, 7, {h, 0.5}, {h, -0.5});
  std::erase_if(four.contacts, [](const dem::Contact& c) { return std::abs(c.normal.x()) < 0.1; });
  const TensorAxes axes = tensor_axes(grain_facts(four)[middle].fabric, 2);
  EXPECT_NEAR(axes.values[0], 3, 1e-13);
  EXPECT_NEAR(axes.values[1], 1, 1e-13);
  EXPECT_NEAR(axes.deviatoric_fraction(), 0.5, 1e-13);
  EXPECT_NEAR(axes.angle_deg(), 0, 1e-12);
  EXPECT_NEAR(tensor_axes(grain_facts(turned(four, 0.3))[middle].fabric, 2).angle_deg(),
              0.3 / kDegree, 1e-11);
}

TEST(SizeFactor, EqualGrainsAndTwoSizes) {
  const SizeFactor equal = size_factor(lattice(6, 5, {1, 0}, {0, 1}));
  EXPECT_EQ(equal.grains, 30);
  EXPECT_NEAR(equal.coordination, 2.0 * 49 / 30, 1e-14);
  EXPECT_NEAR(equal.measured, 1, 1e-14);
  EXPECT_NEAR(equal.theory, 1, 1e-14);
  // A disk of radius 2 in the middle of six of radius 1: sum V c = pi (4 * 6 + 6 * 1),
  // sum V = pi (4 + 6), sum c = 12.
  dem::Snapshot star;
  star.grains.push_back(test::disk(0, 0, 0, 2));
  for (int k = 0; k < 6; ++k) {
    star.grains.push_back(test::disk(k + 1, 3 * std::cos(k), 3 * std::sin(k), 1));
    press(star, 0, k + 1, 1);
  }
  EXPECT_NEAR(size_factor(star).measured, 7.0 * 30 / (10 * 12), 1e-13);
  star.contacts.clear();
  EXPECT_TRUE(std::isnan(size_factor(star).measured));
  star.grains.clear();
  EXPECT_THAT(refusal_of([&] { size_factor(star); }), HasSubstr("no free grain"));
}

TEST(SizeFactor, TheoryForTwoSizesAndUniform) {
  // Radii 1 and 3: mean 2; omega = 2 asin(1 / 1.5), 2 asin(1 / 2.5).
  const double small = 1 / std::asin(1 / 1.5), large = 1 / std::asin(1 / 2.5);
  EXPECT_NEAR(size_factor_theory(Eigen::Vector2d(1, 3), 2),
              (small + 9 * large) / 2 / (5 * (small + large) / 2), 1e-14);
  const auto cap = [](double s) { return 1 / (1 - std::sqrt(1 - s * s)); };
  EXPECT_NEAR(size_factor_theory(Eigen::Vector2d(1, 3), 3),
              (cap(1 / 1.5) + 27 * cap(1 / 2.5)) / 2 / (14 * (cap(1 / 1.5) + cap(1 / 2.5)) / 2),
              1e-14);
  // Uniform +-30 %, by the midpoint rule; no unit in it.
  Eigen::VectorXd radii(20000);
  for (int k = 0; k < 20000; ++k) radii[k] = 0.7 + 0.6 * (k + 0.5) / 20000;
  EXPECT_NEAR(size_factor_theory(radii, 2), 1.0322, 1e-4);
  EXPECT_NEAR(size_factor_theory(1e-3 * radii, 2), size_factor_theory(radii, 2), 1e-12);
}

TEST(SizeFactor, TheAngleOfTheTheoryIsThatOfAClosedRing) {
  // n disks of the mean radius 1 that touch each other close the ring about a disk of radius a when
  // (1 + a) sin(pi/n) = 1: it has n = 2 pi/Omega(a) contacts, the most it can have. Two such grains
  // with m and n contacts have g2 = 2 (a^2 m + b^2 n)/((a^2 + b^2)(m + n)); with a + b = 2 their
  // mean is 1 again.
  const auto ring = [](double a) { return std::numbers::pi / std::asin(1 / (1 + a)); };
  for (int n = 4; n <= 12; ++n) {
    const double a = 1 / std::sin(std::numbers::pi / n) - 1;
    EXPECT_NEAR(ring(a), n, 1e-12);
    if (a >= 2) continue;
    const double b = 2 - a, m = ring(b);
    EXPECT_NEAR(size_factor_theory(Eigen::Vector2d(a, b), 2),
                2 * (a * a * n + b * b * m) / ((a * a + b * b) * (n + m)), 1e-12)
        << n;
  }
}

TEST(BaseForces, CarryTheWeight) {
  for (const bool rough : {false, true}) {
    dem::Snapshot s = test::layer(3, 12, 6, rough);
    if (!rough) s.contacts.push_back(s.contacts.front());  // two contacts of a grain are added
    dem::Vec3 half(0, 0, 0);
    if (!rough) {
      for (dem::Contact& c : s.contacts)
        if (c.i == s.contacts.back().i && c.j == s.contacts.back().j) c.force /= 2, half = c.force;
    }
    const BaseForces base = base_forces(s);
    EXPECT_EQ(base.force.size(), 12);
    EXPECT_TRUE(std::is_sorted(base.x.begin(), base.x.end()));
    double walls = 0;
    for (const dem::Contact& c : s.contacts)
      if (c.j < 0 && s.walls[static_cast<std::size_t>(-1 - c.j)].name != "floor")
        walls += c.force.y();
    EXPECT_NEAR(base.force.sum(), test::weight(s) - walls, 1e-9 * test::weight(s));
    EXPECT_NEAR(base.normalised.mean(), 1, 1e-14);
    // Vertical is against gravity, whatever the axes.
    EXPECT_LT((base_forces(turned(s, 0.2)).force - base.force).norm(), 1e-9 * base.mean);
  }
  dem::Snapshot loose;
  loose.grains.push_back(test::disk(1, 0, 0, 1));
  EXPECT_THAT(refusal_of([&] { base_forces(loose); }), HasSubstr("no free grain touches the base"));
}

TEST(Histogram, CountsAndDensity) {
  Eigen::VectorXd numbers(8);
  numbers << -1, 0, 0.5, 0.5, 1, 2, 2.5, NAN;
  const DensityHistogram h = density_histogram(numbers, 0, 2, 4);
  EXPECT_THAT(std::vector<int>(h.counts.begin(), h.counts.end()), ElementsAre(1, 2, 1, 1));
  EXPECT_EQ(h.outside, 2);
  EXPECT_NEAR(h.density.sum() * 0.5, 5.0 / 7, 1e-15);
  EXPECT_NEAR(h.error[1], std::sqrt(2) / (7 * 0.5), 1e-15);
  EXPECT_EQ(h.centres()[3], 1.75);
  EXPECT_THAT(refusal_of([&] { density_histogram(numbers, 2, 2, 3); }),
              HasSubstr("3 bins from 2 to 2"));
  // An exponential sample: every bin within five standard deviations of the exact share.
  std::mt19937_64 random(5);
  Eigen::VectorXd sample(100000);
  for (double& v : sample) v = -std::log1p(-static_cast<double>(random() >> 11) * 0x1p-53);
  const DensityHistogram p = density_histogram(sample, 0, 5, 20);
  for (int k = 0; k < 20; ++k) {
    const double exact = (std::exp(-p.edges[k]) - std::exp(-p.edges[k + 1])) / 0.25;
    EXPECT_NEAR(p.density[k], exact, 5 * p.error[k]);
  }
}

TEST(Coordination, OfALatticeWithRattlers) {
  dem::Snapshot s = lattice(5, 4, {1, 0}, {0, 1});
  s.grains.push_back(test::disk(100, 50, 50, 0.5));  // touches nothing
  s.grains.push_back(test::disk(101, 5, 0, 0.5));    // leans on one grain
  press(s, 4, 21, 1);
  s.grains.push_back(test::disk(102, 60, 60, 0.5));
  s.grains.back().fixed = true;
  const CoordinationCounts counts = coordination_counts(s);
  EXPECT_EQ(counts.grains, 22);
  EXPECT_EQ(counts.rattlers, 2);
  // 4 corners with 2, one of them with 3 by the leaning grain; 10 on edges with 3; 6 inside with 4.
  EXPECT_THAT(counts.with, ElementsAre(1, 1, 3, 11, 6));
  EXPECT_THAT(counts.with_bearing, ElementsAre(0, 0, 4, 10, 6));
  EXPECT_NEAR(counts.mean, (1 + 6 + 33 + 24) / 22.0, 1e-15);
  EXPECT_NEAR(counts.mean_bearing, (8 + 30 + 24) / 20.0, 1e-15);
  EXPECT_TRUE(std::isnan(coordination_counts(dem::Snapshot()).mean));
}

TEST(GrainAxes, OfRectangles) {
  dem::Snapshot s;
  for (int k = 0; k < 7; ++k) {
    dem::Grain g = test::disk(k, k, 0, 1);
    if (k != 3) g.outline = {{-1.5, -0.5}, {1.5, -0.5}, {1.5, 0.5}, {-1.5, 0.5}};
    g.angle = 0.3 + std::numbers::pi * k;
    s.grains.push_back(g);
  }
  s.grains[6].fixed = true;
  const GrainAxes axes = grain_axes(s);
  ASSERT_EQ(axes.long_angle_deg.size(), 6);
  EXPECT_TRUE(std::isnan(axes.long_angle_deg[3]));
  EXPECT_NEAR(axes.elongation[3], 1, 1e-14);
  EXPECT_NEAR(axes.long_angle_deg[1], 0.3 / kDegree, 1e-11);
  EXPECT_NEAR(axes.inertia_angle_deg[1], 0.3 / kDegree - 90, 1e-11);
  EXPECT_NEAR(axes.elongation[1], 3, 1e-12);
  EXPECT_NEAR(axes.order, 1, 1e-12);
  EXPECT_NEAR(axes.director_deg, 0.3 / kDegree, 1e-11);
  s.grains[0].angle = 0.3;
  for (int k : {1, 4}) s.grains[static_cast<std::size_t>(k)].angle = 0.3 + std::numbers::pi / 2;
  // Three along, two across.
  EXPECT_NEAR(grain_axes(s).order, 0.2, 1e-12);
  s.dim = 3;
  EXPECT_THAT(refusal_of([&] { grain_axes(s); }), HasSubstr("is 3D"));
}

}  // namespace
}  // namespace grainfield::coupling
