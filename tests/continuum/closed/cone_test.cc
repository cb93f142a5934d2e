// Oriented stress linearity in a cone: balance of forces, closures, its ends, the weight.
#include "continuum/closed/cone.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>

#include "continuum/constants.h"
#include "dem/random/random.h"

namespace grainfield::continuum {
namespace {

using dem::Random;
using ::testing::HasSubstr;

struct Cone {
  double phi;
  Closure closure;
};

// Slopes of 10 to 45 degrees, mu from a strong dip to a strong peak, eta as yield asks for or not.
Cone random_cone(Random& random) {
  const double phi = random.uniform(10, 45) * kDegree, c = 1 / std::tan(phi);
  const double mu = random.uniform(-2, 0.8 * c);
  double eta = eta_at_yield(phi, mu);
  if (!(eta > 0.02) || random.uniform() < 0.5) {
    eta = random.uniform(0.05, 0.9) * c * (c - mu);
  }
  return {phi, {eta, mu}};
}

// div sigma and gravity by central differences of the six components, over rho g.
template <class AnyCone>
double imbalance(const AnyCone& cone, const Eigen::Vector3d& at, double step) {
  Eigen::Vector3d sum(0, 0, -1);
  const int index[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  for (int j = 0; j < 3; ++j) {
    Eigen::Vector3d ahead = at, behind = at;
    ahead[j] += step;
    behind[j] -= step;
    const auto a = cone.stress(ahead.x(), ahead.y(), ahead.z());
    const auto b = cone.stress(behind.x(), behind.y(), behind.z());
    for (int i = 0; i < 3; ++i) {
      const auto c = static_cast<std::size_t>(index[i][j]);
      sum[i] += (a[c] - b[c]) / (2 * step);
    }
  }
  return sum.norm();
}

TEST(OslCone, BalancesGravityEverywhere) {
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Cone c = random_cone(random);
    const OslCone cone(c.phi, c.closure, 1);
    for (int k = 0; k < 20; ++k) {
      const double S = random.uniform(0.02, 0.98), angle = random.uniform(0, 2 * std::numbers::pi);
      if (std::fabs(S - cone.singular()) < 0.02) continue;
      const double r = S / std::tan(c.phi);
      const Eigen::Vector3d at(r * std::cos(angle), r * std::sin(angle), -1);
      const double whole = imbalance(cone, at, 2e-3), half = imbalance(cone, at, 1e-3);
      // What is left is the differences' own error, of second order.
      EXPECT_LT(half, 0.3 * whole + 2e-8)
          << "phi " << c.phi / kDegree << " eta " << c.closure.eta << " mu " << c.closure.mu
          << " S " << S << " S0 " << cone.singular();
    }
  }
}

TEST(OslCone, IsContinuousAtTheCharacteristicFromTheApex) {
  Random random(4);
  for (int trial = 0; trial < 500; ++trial) {
    const Cone c = random_cone(random);
    const OslCone cone(c.phi, c.closure, 1);
    const double S0 = cone.singular();
    const auto below = cone.reduced(S0 * (1 - 1e-9)), above = cone.reduced(S0 * (1 + 1e-9));
    // p is matched; that q then is, too, is what the singular equation asks for.
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(below[k], above[k], 2e-7 * (1 + below[k])) << S0;
  }
}

TEST(OslCone, ItsBaseCarriesItsWeight) {
  Random random(5);
  for (int trial = 0; trial < 500; ++trial) {
    const Cone c = random_cone(random);
    const OslCone cone(c.phi, c.closure, 1);
    using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
    const auto ring = [&](double S) { return cone.reduced(S)[1] * S; };
    const double S0 = cone.singular();
    // Weight h^3 pi/(3 c^2), force 2 pi h^3/c^2 times the integral of p S.
    EXPECT_NEAR(Rule::integrate(ring, 0.0, S0, 12) + Rule::integrate(ring, S0, 1.0, 12), 1.0 / 6,
                1e-8);
  }
}

TEST(OslCone, ObeysItsClosuresAndHasNoStressOnItsSurface) {
  const auto model = make_model("cone_osl", {{"phi_deg", "30"}, {"mu", "-0.4"}, {"rho_g", "2"}});
  const double eta = model->figures().at("eta"), c = std::tan(30 * kDegree);
  EXPECT_NEAR(eta, eta_at_yield(30 * kDegree, -0.4), 1e-15);
  Eigen::MatrixXd points(4, 3);
  points << 0.4, 0, -1, 0, 0.4, -1, 0, 0, -1, 1 / c * (1 - 1e-12), 0, -1;
  const Stresses s = model->stress(points);
  EXPECT_DOUBLE_EQ(s(0, 0), s(0, 1));  // rr and tt
  EXPECT_NEAR(-s(0, 0), eta * -s(0, 2) - 0.4 * s(0, 4), 1e-12);
  EXPECT_NEAR(s(1, 3), s(0, 4), 1e-15);
  EXPECT_NEAR(s(1, 2), s(0, 2), 1e-15);
  EXPECT_EQ(s(2, 4), 0);
  EXPECT_NEAR(-s(2, 0), eta * -s(2, 2), 1e-9);
  EXPECT_LT(s.row(3).norm(), 1e-9);
  const Stresses outside = model->stress((Eigen::MatrixXd(2, 3) << 2, 0, -1, 0, 0, 0.1).finished());
  EXPECT_TRUE(outside.array().isNaN().all());
}

TEST(LevyCone, BalancesGravityEverywhere) {
  Random random(6);
  for (int trial = 0; trial < 200; ++trial) {
    const double phi = random.uniform(5, 60) * kDegree;
    const LevyCone cone(phi, 1);
    for (int k = 0; k < 20; ++k) {
      const double S = random.uniform(0.02, 0.98), angle = random.uniform(0, 2 * std::numbers::pi);
      if (std::fabs(S - cone.singular()) < 0.02) continue;
      const double r = S / std::tan(phi);
      const Eigen::Vector3d at(r * std::cos(angle), r * std::sin(angle), -1);
      const double whole = imbalance(cone, at, 2e-3), half = imbalance(cone, at, 1e-3);
      EXPECT_LT(half, 0.3 * whole + 2e-8) << "phi " << phi / kDegree << " S " << S;
    }
  }
}

TEST(LevyCone, ObeysItsClosuresAndEndsAtItsSurface) {
  Random random(7);
  for (int trial = 0; trial < 500; ++trial) {
    const double phi = random.uniform(5, 60) * kDegree, c = std::tan(phi);
    const LevyCone cone(phi, 2);
    const double S0 = cone.singular();
    const auto below = cone.reduced(S0 * (1 - 1e-9)), above = cone.reduced(S0 * (1 + 1e-9));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(below[k], above[k], 1e-7) << S0;
    EXPECT_NEAR(cone.reduced(0)[1], 1 - std::numbers::pi / 2 * std::sin(phi), 1e-14);
    for (const double value : cone.reduced(1)) EXPECT_NEAR(value, 0, 1e-12);
    const double S = random.uniform(0, 1);
    const auto s = cone.stress(S / c, 0, -1);
    EXPECT_NEAR(s[1], (s[0] + s[2]) / 2, 1e-12);  // tt is yy there
    EXPECT_NEAR(-s[0], -s[2] - 2 * c * s[4], 1e-12);
    using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
    const auto ring = [&](double at) { return cone.reduced(at)[1] * at; };
    EXPECT_NEAR(Rule::integrate(ring, 0.0, S0, 12) + Rule::integrate(ring, S0, 1.0, 12), 1.0 / 6,
                1e-8);
  }
}

// Wittmer, Cates and Claudin: fixed principal axes dip, mu = 0 has its largest pressure inside.
TEST(OslCone, FixedAxesDip) {
  const auto fpa = make_model("cone_fpa", {{"phi_deg", "30"}})->figures();
  const auto bcc = make_model("cone_bcc", {{"phi_deg", "30"}})->figures();
  EXPECT_LT(fpa.at("dip_ratio"), 0.7);
  EXPECT_GT(fpa.at("base_largest_at"), 0.1);
  EXPECT_GT(bcc.at("dip_ratio"), fpa.at("dip_ratio"));
  const auto levy = make_model("cone_fpa_levy", {{"phi_deg", "30"}})->figures();
  EXPECT_NEAR(levy.at("base_centre"), 1 - std::numbers::pi / 4, 1e-14);
  EXPECT_NEAR(levy.at("dip_ratio"), 0.3458, 1e-4);
}

TEST(OslCone, RefusesWhatHasNoSolution) {
  for (const char* eta : {"5", "100"}) {
    try {
      make_model("cone_osl", {{"phi_deg", "40"}, {"eta", eta}, {"mu", "0"}});
      FAIL() << eta;
    } catch (const BadParameter& e) {
      EXPECT_THAT(e.what(), HasSubstr("model cone_osl: eta = "));
      EXPECT_THAT(e.what(), HasSubstr("hyperbolic range"));
    }
  }
}

}  // namespace
}  // namespace grainfield::continuum
