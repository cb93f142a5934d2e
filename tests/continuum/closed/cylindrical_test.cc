// Stresses in cylindrical axes: by rotation matrices, models turned about the load, Boussinesq's
// formulas as they stand in books.
#include "continuum/cylindrical.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "dem/random/random.h"

namespace grainfield::continuum {
namespace {

using dem::Random;

TEST(CylindricalAxes, AreARotation) {
  Random random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    Stresses s(1, 6);
    for (int c = 0; c < 6; ++c) s(0, c) = random.uniform(-1, 1);
    const double angle = random.uniform(-3, 3), r = random.uniform(0.1, 2);
    Eigen::Matrix3d tensor;
    tensor << s(0), s(5), s(4), s(5), s(1), s(3), s(4), s(3), s(2);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Matrix3d turned = turn.transpose() * tensor * turn;
    const Stresses found = in_cylindrical_axes(
        (Points(1, 3) << r * std::cos(angle), r * std::sin(angle), -1).finished(), s);
    const int index[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    for (int c = 0; c < 6; ++c)
      EXPECT_NEAR(found(0, c), turned(index[c][0], index[c][1]), 1e-14) << c;
  }
}

TEST(CylindricalAxes, ModelsOfSpaceAreTheSameAllRound) {
  const std::pair<const char*, Settings> models[] = {
      {"boussinesq", {{"nu", "0.2"}}},
      {"layer", {{"dim", "3"}, {"nu", "0.3"}, {"base", "rough"}}},
      {"transverse_half_space", {{"E_h", "2"}, {"G_v", "0.4"}}},
      {"transverse_layer", {{"E_h", "2"}, {"G_v", "0.4"}}}};
  for (const auto& [name, settings] : models) {
    const auto model = make_model(name, settings);
    Points points(7, 3);
    for (int k = 0; k < 7; ++k) points.row(k) << 0.5 * std::cos(k), 0.5 * std::sin(k), -0.6;
    const Stresses plain = model->stress(points), s = in_cylindrical_axes(points, plain);
    for (int k = 0; k < 7; ++k) {
      // At the angle 0 the axes agree.
      EXPECT_LT((s.row(k) - plain.row(0)).norm(), 1e-10) << name;
      EXPECT_NEAR(s(k, 3), 0, 1e-12) << name;
      EXPECT_NEAR(s(k, 5), 0, 1e-12) << name;
    }
  }
}

TEST(CylindricalAxes, BoussinesqIsThatOfTheBooks) {
  // Johnson 1985, eq. 3.20; z down there, so that rz changes its sign.
  const double nu = 0.3, z = 0.7;
  const auto model = make_model("boussinesq", {{"F", "1"}, {"nu", "0.3"}});
  for (const double r : {0.1, 0.5, 2.}) {
    const Points point = (Points(1, 3) << 0.6 * r, -0.8 * r, -z).finished();
    const Stresses s = in_cylindrical_axes(point, model->stress(point));
    const double rho = std::hypot(r, z), scale = 1 / (2 * std::numbers::pi);
    const double side = (1 - 2 * nu) * (1 / (r * r) - z / (rho * r * r));
    EXPECT_NEAR(s(0, 0), scale * (side - 3 * z * r * r / std::pow(rho, 5)), 1e-12);
    EXPECT_NEAR(s(0, 1), scale * (-side + (1 - 2 * nu) * z / std::pow(rho, 3)), 1e-12);
    EXPECT_NEAR(s(0, 2), -scale * 3 * z * z * z / std::pow(rho, 5), 1e-12);
    EXPECT_NEAR(s(0, 4), scale * 3 * r * z * z / std::pow(rho, 5), 1e-12);
  }
}

TEST(CylindricalAxes, OnTheAxisRIsX) {
  const Stresses s = (Stresses(1, 6) << 1, 2, 3, 4, 5, 6).finished();
  EXPECT_EQ(in_cylindrical_axes(Points::Zero(1, 3), s), s);
}

}  // namespace
}  // namespace grainfield::continuum
