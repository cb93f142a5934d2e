// Layers with the load below their surface, against Mindlin's half space, the balance of forces
// and the load on the surface.
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "continuum/model.h"

using namespace grainfield::continuum;

namespace {

// sigma_zz of a unit force at depth c of a half space, down; z down, r from the axis (Mindlin
// 1936).
double mindlin(double nu, double c, double r, double z) {
  const double below = z - c, image = z + c;
  const double a = std::hypot(r, below), b = std::hypot(r, image);
  const double sum =
      -(1 - 2 * nu) * below / std::pow(a, 3) + (1 - 2 * nu) * below / std::pow(b, 3) -
      3 * std::pow(below, 3) / std::pow(a, 5) -
      (3 * (3 - 4 * nu) * z * image * image - 3 * c * image * (5 * z - c)) / std::pow(b, 5) -
      30 * c * z * std::pow(image, 3) / std::pow(b, 7);
  return sum / (8 * M_PI * (1 - nu));
}

// sigma_zz of a line of such forces, x from it.
double mindlin_line(double nu, double c, double x, double z) {
  const auto f = [&](double t) {  // y = z t/(1 - t^2)
    const double y = z * t / (1 - t * t);
    return mindlin(nu, c, std::hypot(x, y), z) * z * (1 + t * t) / std::pow(1 - t * t, 2);
  };
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(f, -1., 1., 12, 1e-10);
}

}  // namespace

TEST(FeBuriedLoad, MeetsMindlinFarAboveTheBase) {
  constexpr double kBelow = 0.005;  // the base, at 1, changes the stress at ten times this by 1e-3
  for (const double nu : {0.1, 0.4}) {
    const auto model = make_model(
        "fe_elastic_layer", {{"load_depth", std::to_string(kBelow)}, {"nu", std::to_string(nu)}});
    for (const double z : {0.02, 0.03, 0.05}) {
      const double peak = mindlin_line(nu, kBelow, 0, z);
      for (const double x : {0., 0.01, 0.03}) {
        const Stresses found = model->stress((Points(2, 2) << x, -z, -x, -z).finished());
        EXPECT_NEAR(found(0, 1) / peak, mindlin_line(nu, kBelow, x, z) / peak, 0.01)
            << "nu " << nu << " x " << x << " z " << z;
        EXPECT_EQ(found(0, 1), found(1, 1));
      }
    }
  }
}

TEST(FeBuriedLoad, TheMaterialBelowCarriesWhatIsAboveIt) {
  constexpr double kBelow = 0.3, kSpread = kBelow / 5;
  const auto model =
      make_model("fe_elastic_layer", {{"load_depth", "0.3"}, {"F", "300"}, {"E", "1"}});
  constexpr int kPoints = 8000;
  const Eigen::ArrayXd x = (Eigen::ArrayXd::LinSpaced(kPoints, 0, kPoints - 1) + 0.5) * 8 / kPoints;
  for (const double z : {0.1, 0.25, 0.3, 0.35, 0.6, 1.0}) {
    Points points(kPoints, 2);
    points << x, Eigen::ArrayXd::Constant(kPoints, -z);
    const double carried = -2 * model->stress(points).col(1).sum() * 8 / kPoints;
    const double above = 0.5 * std::erfc(-(z - kBelow) / kSpread / std::sqrt(2));
    EXPECT_NEAR(carried / 300, above, 3e-3) << z;
  }
}

// The stress under a load at depth c is that under one on the surface, with a change in proportion
// to c.
TEST(FeBuriedLoad, TendsToTheLoadOnTheSurfaceOfAGradedLayer) {
  const std::string file = ::testing::TempDir() + "fe_buried_load.csv";
  std::ofstream(file) << "depth,E,nu\n0,1,0.2\n0.5,1.5,0.25\n1,2.5,0.3\n";
  for (const char* base : {"smooth", "rough"}) {
    const auto of = [&](const char* below) {
      const Points points =
          (Points(5, 2) << 0, -0.5, 0.4, -0.5, 0, -0.75, 0, -1, 0.5, -1).finished();
      return make_model("fe_elastic_layer",
                        {{"moduli", file}, {"base", base}, {"load_depth", below}})
          ->stress(points);
    };
    const Stresses surface = of("0"), near = of("0.02"), far = of("0.04");
    const double peak = surface.col(1).cwiseAbs().maxCoeff();
    EXPECT_LT((2 * near - far - surface).cwiseAbs().maxCoeff(), 4e-3 * peak);
    EXPECT_GT((far - surface).cwiseAbs().maxCoeff(), 2e-2 * peak);
  }
  std::remove(file.c_str());
}

TEST(FeBuriedLoad, RefusesOneThatNoMeshResolves) {
  for (const char* below : {"1e-5", "1e-300", "0.95", "-0.1", "nan"})
    EXPECT_THROW(make_model("fe_elastic_layer", {{"load_depth", below}}), BadParameter) << below;
}

TEST(FeBuriedLoad3d, MeetsMindlinFarAboveTheBase) {
  constexpr double kBelow = 0.02;
  const auto model = make_model("fe_elastic_layer", {{"dim", "3"},
                                                     {"load_depth", std::to_string(kBelow)},
                                                     {"half_width", "2"},
                                                     {"degree", "3"},
                                                     {"nu", "0.25"}});
  for (const double z : {0.06, 0.08, 0.12}) {
    const double peak = mindlin(0.25, kBelow, 0, z);
    for (const double r : {0., 0.03, 0.08}) {
      const Stresses found =
          model->stress((Points(2, 3) << r, 0, -z, -0.6 * r, 0.8 * r, -z).finished());
      EXPECT_NEAR(found(0, 2) / peak, mindlin(0.25, kBelow, r, z) / peak, 0.02) << r << " " << z;
      EXPECT_NEAR(found(1, 2) / peak, found(0, 2) / peak, 0.02) << r << " " << z;
    }
  }
}
