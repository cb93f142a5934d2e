// The elastic layer under a point load in space.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "continuum/model.h"

using namespace grainfield::continuum;

namespace {

std::unique_ptr<Model> layer(double nu, const std::string& base, const std::string& dim = "3",
                             double h = 1) {
  return make_model("layer", {{"F", "1"},
                              {"h", std::to_string(h)},
                              {"nu", std::to_string(nu)},
                              {"base", base},
                              {"dim", dim}});
}

Eigen::VectorXd at(Model& model, double x, double y, double z) {
  return model.stress((Points(1, 3) << x, y, z).finished()).row(0).transpose();
}

}  // namespace

// Peaks at the base over F/h^2, from integrals of the plane's transfer functions.
TEST(LayerInSpace, PeaksAtTheBase) {
  EXPECT_NEAR(-at(*layer(0.2, "smooth"), 0, 0, -1)[2], 0.8225, 5e-5);
  EXPECT_NEAR(-at(*layer(0, "rough"), 0, 0, -1)[2], 0.7026, 5e-5);
  EXPECT_NEAR(-at(*layer(0.3, "rough"), 0, 0, -1)[2], 0.6942, 5e-5);
  EXPECT_NEAR(-at(*layer(0.45, "rough"), 0, 0, -1)[2], 0.7248, 5e-5);
}

// A row of point loads is a line load: integrals over y give the plane's stresses, and nu of both
// in-plane normals along y. On a smooth base the horizontal stresses fall as 1/r^2, as in a sheet:
// what rows of two lengths leave out is as 2 to 1.
TEST(LayerInSpace, ARowOfPointsIsALine) {
  for (const char* base : {"smooth", "rough"}) {
    const double nu = 0.3, x = 0.4, z = -0.6;
    const auto space = layer(nu, base), plane = layer(nu, base, "2");
    const auto row = [&](double length) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(6);
      const int n = static_cast<int>(50 * length);
      const double step = 2 * length / n;
      for (int k = 0; k < n; ++k) sum += step * at(*space, x, -length + (k + 0.5) * step, z);
      return sum;
    };
    const Eigen::VectorXd sum = 2 * row(16) - row(8);
    const Eigen::VectorXd line =
        plane->stress((Points(1, 2) << x, z).finished()).row(0).transpose();
    EXPECT_NEAR(sum[0], line[0], 2e-4) << base;
    EXPECT_NEAR(sum[2], line[1], 2e-4) << base;
    EXPECT_NEAR(sum[4], line[2], 2e-4) << base;
    EXPECT_NEAR(sum[1], nu * (line[0] + line[1]), 2e-4) << base;
  }
}

TEST(LayerInSpace, BalanceAtRandomPointsAndNoShearOnASmoothBase) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> across(-1.5, 1.5), depth(0.15, 0.9), share(0, 0.5);
  for (int trial = 0; trial < 40; ++trial) {
    const auto model = layer(share(random), trial % 2 == 0 ? "smooth" : "rough");
    const Eigen::Vector3d p(across(random), across(random), -depth(random));
    const double e = 1e-4;
    Eigen::Vector3d divergence = Eigen::Vector3d::Zero();
    double size = 0;
    for (int b = 0; b < 3; ++b) {
      const Eigen::Vector3d step = e * Eigen::Vector3d::Unit(b), f = p + step, g = p - step;
      const Eigen::VectorXd d =
          (at(*model, f.x(), f.y(), f.z()) - at(*model, g.x(), g.y(), g.z())) / (2 * e);
      const int column[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
      for (int a = 0; a < 3; ++a) divergence[a] += d[column[a][b]];
      size = std::max(size, d.norm());
    }
    EXPECT_LT(divergence.norm(), 1e-6 * (1 + size)) << p.transpose();
  }
  const Eigen::VectorXd base = at(*layer(0.3, "smooth"), 0.3, 0.4, -1);
  EXPECT_NEAR(base[3], 0, 1e-12);
  EXPECT_NEAR(base[4], 0, 1e-12);
}

TEST(LayerInSpace, CarriesTheLoadAndTendsToTheHalfSpace) {
  for (const char* base : {"smooth", "rough"}) {
    const auto model = layer(0.25, base);
    for (const double z : {-0.3, -1.0}) {
      double sum = 0;
      const int n = 2000;
      for (int k = 0; k < n; ++k) {
        const double r = 10 * (k + 0.5) / n;
        sum -= 2 * M_PI * r * 10 / n * at(*model, r, 0, z)[2];
      }
      EXPECT_NEAR(sum, 1, 1e-4) << base << z;
    }
  }
  const auto deep = layer(0.25, "rough", "3", 300);
  const auto half = make_model("boussinesq", {{"F", "1"}, {"nu", "0.25"}});
  EXPECT_LT((at(*deep, 0.4, 0.5, -0.7) - at(*half, 0.4, 0.5, -0.7)).norm(),
            1e-3 * at(*half, 0.4, 0.5, -0.7).norm());
  EXPECT_TRUE(std::isnan(at(*deep, 0, 0, 0.1)[2]));
  EXPECT_TRUE(std::isnan(at(*layer(0.25, "rough"), 0, 0, -1.1)[2]));
}

// The stress of many points is interpolated, that of few is not.
TEST(LayerInSpace, ManyPointsAreAsTheyAreByThemselves) {
  std::mt19937 bits(4);
  std::uniform_real_distribution<double> side(-1.7, 1.7), height(-1, 0);
  Points many(1800, 3);
  for (auto point : many.rowwise()) point << side(bits), side(bits), height(bits);
  many.row(0) << 0, 0, -1;
  for (const char* base : {"smooth", "rough"}) {
    const auto model = layer(0.3, base);
    const Stresses together = model->stress(many);
    Stresses apart(many.rows(), 6);
    constexpr int kFew = 200;
    for (int k = 0; k < many.rows(); k += kFew)
      apart.middleRows(k, kFew) = model->stress(many.middleRows(k, kFew));
    // The base adds up to 0.6; rounding of a sum over 500 waves is 1e-14.
    EXPECT_LT((together - apart).cwiseAbs().maxCoeff(), 1e-12) << base;
  }
}
