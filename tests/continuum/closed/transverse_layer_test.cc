// A point load on a transversely isotropic layer: the isotropic layer, a row of loads against the
// plane's closed form, balance, the load at every depth, the base, a deep layer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "continuum/closed/transverse.h"
#include "continuum/model.h"
#include "dem/random/random.h"

namespace grainfield::continuum {
namespace {

using dem::Random;
using ::testing::HasSubstr;

// Numbers as settings with all their digits.
std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

Settings settings_of(const TransverseModuli& m, const std::string& base, double h = 1) {
  return {{"F", "1"},           {"h", text(h)},         {"E_h", text(m.E_h)},
          {"E_v", text(m.E_v)}, {"nu_h", text(m.nu_h)}, {"nu_v", text(m.nu_v)},
          {"G_v", text(m.G_v)}, {"base", base}};
}

TransverseModuli random_moduli(Random& random) {
  for (;;) {
    TransverseModuli m;
    m.E_h = std::exp(random.uniform(-1.5, 1.5));
    m.nu_h = random.uniform(-0.4, 0.8);
    m.nu_v = random.uniform(-0.2, 0.6);
    m.G_v = std::exp(random.uniform(-2, 0.3));
    if (!m.is_stable()) continue;
    const Orthotropy o = orthotropy(m.plane_strain());
    if (o.r > -0.5 * std::sqrt(o.t)) return m;
  }
}

Eigen::VectorXd at(Model& model, double x, double y, double z) {
  return model.stress((Points(1, 3) << x, y, z).finished()).row(0).transpose();
}

TEST(TransverseLayer, IsTheIsotropicLayerWhereItIsIsotropic) {
  Random random(1);
  for (int trial = 0; trial < 60; ++trial) {
    const double nu = random.uniform(0, 0.49);
    const std::string base = trial % 2 == 0 ? "smooth" : "rough";
    const auto one =
        make_model("transverse_layer", settings_of({1, 1, nu, nu, 1 / (2 * (1 + nu))}, base));
    const auto other = make_model(
        "layer", {{"F", "1"}, {"h", "1"}, {"nu", text(nu)}, {"base", base}, {"dim", "3"}});
    for (int k = 0; k < 5; ++k) {
      const double x = random.uniform(-2, 2), y = random.uniform(-2, 2),
                   z = -random.uniform(0.1, 1);
      const Eigen::VectorXd a = at(*one, x, y, z), b = at(*other, x, y, z);
      EXPECT_LT((a - b).norm(), 1e-8 * (0.01 + b.norm())) << nu << base;
    }
    const Eigen::VectorXd a = at(*one, 0, 0, -1), b = at(*other, 0, 0, -1);
    EXPECT_NEAR(a[2], b[2], 1e-9);
  }
}

// As of layer (layer_space_test.cc): what rows of two lengths leave out is as 2 to 1.
TEST(TransverseLayer, ARowOfPointsIsALine) {
  Random random(2);
  for (int trial = 0; trial < 6; ++trial) {
    const TransverseModuli m = random_moduli(random);
    const PlaneModuli plane = m.plane_strain();
    const std::string base = trial % 2 == 0 ? "smooth" : "rough";
    const auto space = make_model("transverse_layer", settings_of(m, base));
    const auto line = make_model("orthotropic_layer", {{"F", "1"},
                                                       {"h", "1"},
                                                       {"E_x", text(plane.E_x)},
                                                       {"E_y", text(plane.E_y)},
                                                       {"G", text(plane.G)},
                                                       {"nu_xy", text(plane.nu_xy)},
                                                       {"base", base}});
    const double x = 0.4, z = -0.6;
    const auto row = [&](double length) {
      const int n = static_cast<int>(50 * length);
      const double step = 2 * length / n;
      Points points(n, 3);
      for (int k = 0; k < n; ++k) points.row(k) << x, -length + (k + 0.5) * step, z;
      return Eigen::VectorXd(step * space->stress(points).colwise().sum().transpose());
    };
    const Eigen::VectorXd sum = 2 * row(16) - row(8);
    const Eigen::VectorXd exact =
        line->stress((Points(1, 2) << x, z).finished()).row(0).transpose();
    const double tolerance = 1e-3 * exact.norm() + 2e-4;
    EXPECT_NEAR(sum[0], exact[0], tolerance) << base;
    EXPECT_NEAR(sum[2], exact[1], tolerance) << base;
    EXPECT_NEAR(sum[4], exact[2], tolerance) << base;
    EXPECT_NEAR(sum[1], m.nu_h * exact[0] + m.nu_v * m.E_h / m.E_v * exact[1], tolerance) << base;
  }
}

TEST(TransverseLayer, BalanceAtRandomPointsAndNoShearOnASmoothBase) {
  Random random(3);
  const int index[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  for (int trial = 0; trial < 100; ++trial) {
    const std::string base = trial % 2 == 0 ? "smooth" : "rough";
    const auto model = make_model("transverse_layer", settings_of(random_moduli(random), base));
    const Eigen::Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1),
                            -random.uniform(0.2, 0.9));
    constexpr double kStep = 1e-4;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double size = 0;
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d way = kStep * Eigen::Vector3d::Unit(j), f = p + way, b = p - way;
      const Eigen::VectorXd d =
          (at(*model, f.x(), f.y(), f.z()) - at(*model, b.x(), b.y(), b.z())) / (2 * kStep);
      for (int i = 0; i < 3; ++i) sum[i] += d[index[i][j]];
      size = std::max(size, d.norm());
    }
    EXPECT_LT(sum.norm(), 2e-6 * (1 + size)) << base;
    if (trial % 2 == 0) {
      const Eigen::VectorXd s = at(*model, p.x(), p.y(), -1);
      EXPECT_NEAR(s[3], 0, 1e-8 * (1 + s.norm()));
      EXPECT_NEAR(s[4], 0, 1e-8 * (1 + s.norm()));
    }
  }
}

TEST(TransverseLayer, CarriesTheLoadAndTendsToTheHalfSpace) {
  Random random(4);
  for (int trial = 0; trial < 6; ++trial) {
    const TransverseModuli m = random_moduli(random);
    const std::string base = trial % 2 == 0 ? "smooth" : "rough";
    const auto model = make_model("transverse_layer", settings_of(m, base));
    const int n = 2000;
    const double most = 12, step = most / n;
    Points points(n, 3);
    for (int k = 0; k < n; ++k) points.row(k) << (k + 0.5) * step, 0, -1;
    const Stresses s = model->stress(points);
    double sum = 0;
    for (int k = 0; k < n; ++k) sum -= 2 * M_PI * points(k, 0) * step * s(k, 2);
    EXPECT_NEAR(sum, 1, 1e-3) << base;
    const auto deep = make_model("transverse_layer", settings_of(m, base, 300));
    const TransverseHalfSpace half(1, m);
    const auto exact = half.stress(0.4, 0.5, -0.7);
    const Eigen::VectorXd found = at(*deep, 0.4, 0.5, -0.7);
    for (int c = 0; c < 6; ++c) {
      EXPECT_NEAR(found[c], exact[static_cast<std::size_t>(c)], 2e-3 * found.norm());
    }
  }
}

TEST(TransverseLayer, ItsDomainAndItsSettingsAreChecked) {
  const auto model = make_model("transverse_layer", {{"h", "2"}});
  Points points(4, 3);
  points << 0, 0, -2, 0, 0, -2.1, 0, 0, 0.1, 1e-9, 0, -2;
  const Stresses s = model->stress(points);
  EXPECT_TRUE(s.row(1).array().isNaN().all());
  EXPECT_TRUE(s.row(2).array().isNaN().all());
  EXPECT_NEAR(s(0, 2), s(3, 2), 1e-9);
  const auto complaint = [](const Settings& settings) {
    try {
      make_model("transverse_layer", settings);
    } catch (const BadParameter& e) {
      return std::string(e.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(complaint({{"E_h", "9"}, {"nu_v", "0.4"}}),
              HasSubstr("model transverse_layer: nu_h"));
  EXPECT_THAT(complaint({{"nu_h", "0"}, {"nu_v", "0.706"}, {"G_v", "1e4"}}),
              HasSubstr("G_v = 10000 is too large"));
}

// The stress of many points is interpolated, that of few is not.
TEST(TransverseLayer, ManyPointsAreAsTheyAreByThemselves) {
  Random random(5);
  Points many(1400, 3);
  for (auto point : many.rowwise())
    point << random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 0);
  constexpr int kFew = 200, kTrials = 3;
  for (int trial = 0; trial < kTrials; ++trial) {
    TransverseModuli m = random_moduli(random);
    if (trial == 0) {  // of a layer of spheres: interpolated for certain
      m.E_h = 1.8;
      m.E_v = 2.2;
      m.nu_h = 0.217;
      m.nu_v = 0.272;
      m.G_v = 0.83;
    }
    const auto model =
        make_model("transverse_layer", settings_of(m, trial % 2 == 0 ? "rough" : "smooth"));
    const Stresses together = model->stress(many);
    Stresses apart(many.rows(), 6);
    for (int k = 0; k < many.rows(); k += kFew)
      apart.middleRows(k, kFew) = model->stress(many.middleRows(k, kFew));
    const double size = apart.bottomRows(kFew).cwiseAbs().maxCoeff();
    EXPECT_LT((together - apart).cwiseAbs().maxCoeff(), 1e-11 * size) << trial;
  }
}

}  // namespace
}  // namespace grainfield::continuum
