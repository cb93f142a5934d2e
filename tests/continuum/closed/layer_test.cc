// The elastic layer: closed forms of its base response, balance, limits.
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <random>

#include "continuum/closed/half_space.h"
#include "continuum/model.h"

using namespace grainfield::continuum;

namespace {

std::unique_ptr<Model> layer(double F, double h, double nu, const std::string& base) {
  return make_model("layer", {{"F", std::to_string(F)},
                              {"h", std::to_string(h)},
                              {"nu", std::to_string(nu)},
                              {"base", base}});
}

Eigen::Vector3d at(Model& model, double x, double y) {
  return model.stress((Points(1, 2) << x, y).finished()).row(0).transpose();
}

/// The base response of a smooth layer, physics.md section 4: an integral of its own.
double smooth_base(double x) {
  const auto f = [x](double u) {
    if (u == 0) return 1.0;
    // sinh and cosh scaled by exp(-u), sinh 2u by exp(-2u): no overflow.
    const double e = std::exp(-2 * u);
    return 2 * std::exp(-u) * ((1 - e) + u * (1 + e)) / ((1 - e * e) + 4 * u * e) * std::cos(u * x);
  };
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(f, 0., 60., 15, 1e-14) /
         M_PI;
}

}  // namespace

TEST(Layer, SmoothBaseMeetsTheClosedIntegralAtEveryPoissonRatio) {
  for (const double nu : {0., 0.2, 0.3, 0.45, 0.5}) {
    const auto model = layer(3, 0.5, nu, "smooth");
    for (const double x : {0., 0.01, 0.3, 1., 2.7, 5.})
      EXPECT_NEAR(at(*model, x, -0.5)(1), -smooth_base(x / 0.5) * 3 / 0.5, 1e-10) << nu << " " << x;
  }
}

TEST(Layer, PeaksOfThePublishedFigures) {
  EXPECT_NEAR(-at(*layer(1, 1, 0.3, "smooth"), 0, -1)(1), 0.9195, 5e-5);
  EXPECT_NEAR(-at(*layer(1, 1, 0.3, "rough"), 0, -1)(1), 0.8078, 5e-5);
}

TEST(Layer, BaseConditionsHold) {
  for (const double nu : {0., 0.3, 0.5}) {
    const auto smooth = layer(1, 1, nu, "smooth"), rough = layer(1, 1, nu, "rough");
    for (const double x : {0.1, 0.7, 2., 9.}) {
      EXPECT_NEAR(at(*smooth, x, -1)(2), 0, 1e-12);
      // No displacement along a rough base: no strain either, (1-nu) sigma_xx = nu sigma_yy.
      const auto s = at(*rough, x, -1);
      EXPECT_NEAR((1 - nu) * s(0), nu * s(1), 1e-12);
      // Nearly at the surface, away from the load, there is no traction.
      EXPECT_NEAR(at(*rough, x, -1e-9)(1), 0, 1e-12);
      EXPECT_NEAR(at(*rough, x, -1e-9)(2), 0, 1e-7);
    }
  }
}

TEST(Layer, BaseResponseIntegratesToTheLoad) {
  for (const char* base : {"smooth", "rough"}) {
    for (const double nu : {0., 0.3, 0.45}) {
      for (const double y : {-1., -0.3}) {
        const auto model = layer(1, 1, nu, base);
        // The response decays like exp(-0.9 x/h) in the slowest of these cases.
        const double total =
            2 * boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
                    [&](double x) { return -at(*model, x, y)(1); }, 0., 40., 7, 1e-11);
        EXPECT_NEAR(total, 1, 1e-8) << base << " nu " << nu << " y " << y;
      }
    }
  }
}

TEST(Layer, BalanceAndCompatibilityAtRandomPoints) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0, 1);
  for (int sample = 0; sample < 40; ++sample) {
    const double nu = 0.5 * any(random);
    const auto model = layer(1, 1, nu, sample % 2 ? "smooth" : "rough");
    const double x = 6 * any(random) - 3, y = -0.1 - 0.8 * any(random);
    // Fourth-order central differences; 1e-10 of the values over the step bounds what is seen.
    const double e = 4e-3;
    const auto d = [&](double dx, double dy) -> Eigen::Vector3d {
      return (8 * (at(*model, x + dx, y + dy) - at(*model, x - dx, y - dy)) -
              (at(*model, x + 2 * dx, y + 2 * dy) - at(*model, x - 2 * dx, y - 2 * dy))) /
             (12 * e);
    };
    const double r = std::hypot(x, y), scale = 1 / (r * r);
    const Eigen::Vector3d dx = d(e, 0), dy = d(0, e);
    const double tolerance = 60 * std::pow(e / r, 4) * scale + 1e-9;
    EXPECT_NEAR(dx(0) + dy(2), 0, tolerance) << x << " " << y;
    EXPECT_NEAR(dx(2) + dy(1), 0, tolerance) << x << " " << y;
    // sigma_xx + sigma_yy is harmonic: mean over the corners of a square equals the centre.
    const auto trace = [&](double px, double py) { return at(*model, px, py).head<2>().sum(); };
    const double mean =
        (trace(x + e, y + e) + trace(x - e, y + e) + trace(x + e, y - e) + trace(x - e, y - e)) / 4;
    EXPECT_NEAR(mean, trace(x, y), 60 * std::pow(e / r, 4) / r + 1e-12);
  }
}

TEST(Layer, DeepLayerTendsToTheHalfPlaneAndNothingOverflows) {
  const auto model = layer(1, 1e4, 0.2, "rough");
  const auto s = at(*model, 0.3, -0.7), half = at(*make_model("flamant", {}), 0.3, -0.7);
  EXPECT_LT((s - half).norm(), 1e-3 * half.norm());
  const auto near = at(*layer(1, 1, 0.2, "rough"), 1e-9, -1e-8);
  const auto near_half = at(*make_model("flamant", {}), 1e-9, -1e-8);
  EXPECT_LT((near - near_half).norm(), 1e-7 * near_half.norm());
  EXPECT_NEAR(at(*layer(1, 1, 0.2, "smooth"), 300, -0.4).norm(), 0, 1e-12);
}

TEST(Layer, MirrorSymmetry) {
  const auto model = layer(1, 1, 0.3, "rough");
  const auto right = at(*model, 0.4, -0.6), left = at(*model, -0.4, -0.6);
  EXPECT_DOUBLE_EQ(right(1), left(1));
  EXPECT_DOUBLE_EQ(right(2), -left(2));
  EXPECT_GT(right(2), 0);  // compression along the ray down and to the right
}

TEST(Layer, OutsideIsNan) {
  const auto model = layer(1, 1, 0.3, "smooth");
  EXPECT_TRUE(std::isnan(at(*model, 0, 0)(1)));
  EXPECT_TRUE(std::isnan(at(*model, 0, 0.1)(1)));
  EXPECT_TRUE(std::isnan(at(*model, 0, -1.001)(1)));
  EXPECT_TRUE(std::isnan(at(*model, NAN, -0.5)(1)));
  EXPECT_FALSE(std::isnan(at(*model, 0, -1 - 1e-13)(1)));
}
