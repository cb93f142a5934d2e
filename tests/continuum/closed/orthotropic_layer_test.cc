// Orthotropic layer: isotropic limit, balance, base conditions, load, half plane far from the base.
#include "continuum/closed/orthotropic_layer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "continuum/model.h"
#include "dem/random/random.h"

using namespace grainfield::continuum;
using grainfield::dem::Random;
using ::testing::HasSubstr;

namespace {

Eigen::Vector3d at(Model& model, double x, double y) {
  return model.stress((Points(1, 2) << x, y).finished()).row(0).transpose();
}

struct Medium {
  Orthotropy o;
  double nu = 0;
};

// Down to r = -0.9 sqrt(t), up to strongly damped.
Medium random_medium(Random& random) {
  Medium out;
  out.o.t = std::exp(random.uniform(-1.5, 1.5));
  out.o.r = std::sqrt(out.o.t) * (-0.9 + std::exp(random.uniform(-3, 1.5)));
  // A solid: above -r, below sqrt(t).
  const double root = std::sqrt(out.o.t);
  out.nu = random.uniform(std::max(-0.4 * root, -0.9 * out.o.r), 0.95 * root);
  return out;
}

Eigen::Vector3d stress(const Medium& m, bool rough, double x, double y) {
  return orthotropic_layer_stress(OrthotropicWaves(m.o, m.nu, rough), m.o, 1, 1,
                                  (Points(1, 2) << x, y).finished())
      .row(0)
      .transpose();
}

}  // namespace

TEST(OrthotropicLayer, IsTheIsotropicLayerForEqualConstants) {
  for (const char* base : {"smooth", "rough"}) {
    for (const double nu : {0.0, 0.2, 0.3, 0.45}) {
      const auto layer = make_model(
          "layer", {{"F", "3"}, {"h", "0.4"}, {"nu", std::to_string(nu)}, {"base", base}});
      const auto orthotropic = make_model(
          "orthotropic_layer",
          {{"F", "3"}, {"h", "0.4"}, {"nu_xy", std::to_string(nu / (1 - nu))}, {"base", base}});
      for (const double x : {0.0, 0.1, -0.5, 1.3}) {
        for (const double y : {-0.05, -0.2, -0.4}) {
          const Eigen::Vector3d a = at(*layer, x, y), b = at(*orthotropic, x, y);
          // nu_xy is handed over with six digits.
          EXPECT_LT((a - b).norm(), 1e-5 * (1 + a.norm())) << base << nu << " " << x << " " << y;
        }
      }
    }
  }
}

TEST(OrthotropicLayer, IsInEquilibrium) {
  Random random(1);
  for (int k = 0; k < 16; ++k) {
    const Medium m = random_medium(random);
    const bool rough = k % 2 == 0;
    const double x = random.uniform(-2, 2), y = -random.uniform(0.2, 0.95), h = 1e-3;
    const auto slope = [&](int axis) -> Eigen::Vector3d {
      const double dx = axis == 0 ? h : 0, dy = axis == 1 ? h : 0;
      const auto difference = [&](double s) -> Eigen::Vector3d {
        return (stress(m, rough, x + s * dx, y + s * dy) -
                stress(m, rough, x - s * dx, y - s * dy)) /
               (2 * s * h);
      };
      return (4 * difference(1) - difference(2)) / 3;
    };
    const Eigen::Vector3d dx = slope(0), dy = slope(1);
    const double size = 1 + dx.norm() + dy.norm();
    EXPECT_NEAR(dx[0] + dy[2], 0, 1e-6 * size) << m.o.r << " " << m.o.t;
    EXPECT_NEAR(dx[2] + dy[1], 0, 1e-6 * size) << m.o.r << " " << m.o.t;
  }
}

TEST(OrthotropicLayer, BaseConditionsAndLoadHold) {
  Random random(2);
  for (int k = 0; k < 41; ++k) {
    const Medium m = random_medium(random);
    const double x = random.uniform(0.1, 2);
    EXPECT_NEAR(stress(m, false, x, -1)[2], 0, 1e-11);
    const Eigen::Vector3d rough = stress(m, true, x, -1);
    EXPECT_NEAR(rough[0], m.nu * rough[1], 1e-10 * (1 + rough.norm()));
    if (k % 20 != 0 || m.o.r < 0) continue;  // slow waves reach far near the hyperbolic limit
    const double total =
        2 * boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
                [&](double z) { return -stress(m, k % 40 == 0, z, -0.7)[1]; }, 0., 60., 6, 1e-8);
    EXPECT_NEAR(total, 1, 1e-5) << m.o.r << " " << m.o.t;
  }
}

// No vertical displacement of a rough base: 2 eps_xy,x = eps_xx,y there, by one-sided differences.
TEST(OrthotropicLayer, BaseDoesNotMoveVertically) {
  Random random(3);
  for (int k = 0; k < 50; ++k) {
    const Medium m = random_medium(random);
    const bool rough = k % 2 == 0;
    const double x = random.uniform(0.1, 1.5), h = 1e-3;
    const auto strain_xx = [&](double y) {
      const Eigen::Vector3d s = stress(m, rough, x, y);
      return s[0] - m.nu * s[1];
    };
    const double normal =
        (-3 * strain_xx(-1) + 4 * strain_xx(-1 + h) - strain_xx(-1 + 2 * h)) / (2 * h);
    const double shear = 2 * (m.o.r + m.nu) *
                         (stress(m, rough, x + h, -1)[2] - stress(m, rough, x - h, -1)[2]) /
                         (2 * h);
    EXPECT_NEAR(shear, normal, 2e-3 * (1 + std::fabs(normal))) << m.o.r << " " << m.o.t;
  }
}

TEST(OrthotropicLayer, IsTheHalfPlaneNearTheLoad) {
  Random random(4);
  for (int k = 0; k < 50; ++k) {
    const Medium m = random_medium(random);
    const double x = random.uniform(-0.002, 0.002), y = -0.002;
    const auto plane = orthotropic_stress(1, m.o, x, y);
    const Eigen::Vector3d there(plane[0], plane[1], plane[2]);
    EXPECT_LT((stress(m, true, x, y) - there).norm(), 0.03 * (1 + there.norm()));
  }
}

TEST(OrthotropicLayer, RefusesWhatIsNoSolidOnARoughBase) {
  try {
    make_model("orthotropic_layer", {{"r", "-0.5"}, {"base", "rough"}});
    FAIL() << "accepted";
  } catch (const BadParameter& e) {
    EXPECT_THAT(e.what(), HasSubstr("nu_xy = 0.3 is of no solid at r = -0.5, t = 1"));
  }
}

TEST(OrthotropicLayer, RefusesTheHyperbolicLimit) {
  try {
    make_model("orthotropic_layer", {{"r", "-1"}});
    FAIL() << "accepted";
  } catch (const BadParameter& e) {
    EXPECT_THAT(e.what(), HasSubstr("allowed: above -0.99 sqrt(t) = -0.99 at t = 1"));
  }
}
