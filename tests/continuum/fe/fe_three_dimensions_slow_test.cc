// Layer and half space in three dimensions, against Boussinesq and the axisymmetric layer.
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <random>

#include "continuum/model.h"

using namespace grainfield::continuum;

TEST(FeHalfSpace, MeetsBoussinesq) {
  const auto model = make_model("fe_elastic_half_space", {{"dim", "3"}, {"nu", "0.2"}});
  const auto exact = make_model("boussinesq", {{"nu", "0.2"}});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0, 1);
  Points points(2000, 3);
  for (int n = 0; n < points.rows(); ++n) {
    const double depth = 0.15 * 0.5 * std::pow(4, any(random));
    points.row(n) << 2 * depth * (2 * any(random) - 1), 2 * depth * (2 * any(random) - 1), -depth;
  }
  points.topRows(200).leftCols(2) *= 0.05;  // some below the load, where the peak is
  const Stresses found = model->stress(points), expected = exact->stress(points);
  for (int n = 0; n < points.rows(); ++n) {
    const double peak = 3 / (2 * M_PI) / std::pow(points(n, 2), 2);  // at this depth
    EXPECT_LT((found - expected).row(n).cwiseAbs().maxCoeff(), 3e-3 * peak) << points.row(n);
  }
}

TEST(FeLayer3d, MeetsTheAxisymmetricLayerOnASmoothBase) {
  // sigma_zz on the base = -(F / 2 pi h^2) Int u 2 (sinh u + u cosh u) / (sinh 2u + 2u) J0(u r/h).
  const auto exact = [](double r) {
    const auto f = [r](double u) {
      if (u == 0) return 0.;
      const double e = std::exp(-2 * u);
      return u * 2 * std::exp(-u) * ((1 - e) + u * (1 + e)) / ((1 - e * e) + 4 * u * e) *
             std::cyl_bessel_j(0, u * r);
    };
    return -boost::math::quadrature::gauss_kronrod<double, 61>::integrate(f, 0., 60., 10, 1e-12) /
           (2 * M_PI);
  };
  const auto model = make_model("fe_elastic_layer", {{"dim", "3"}, {"half_width", "5"}});
  for (const double r : {0., 0.3, 0.8, 1.5}) {
    const auto s = model->stress((Points(2, 3) << r, 0, -1, -0.6 * r, 0.8 * r, -1).finished());
    EXPECT_NEAR(s(0, 2), exact(r), 1e-3 * std::abs(exact(0))) << r;
    EXPECT_NEAR(s(1, 2), exact(r), 1e-3 * std::abs(exact(0))) << r;
  }
}
