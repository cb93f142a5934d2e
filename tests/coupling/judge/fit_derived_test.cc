// What follows from fitted constants: values and errors.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "continuum/closed/osl.h"
#include "continuum/constants.h"
#include "coupling/fit/derived.h"

namespace grainfield::coupling {
namespace {

FittedParameter fitted(const std::string& name, double value, double error) {
  FittedParameter p;
  p.parameter.name = name;
  p.value = value;
  p.error = p.covariance_error = error;
  p.bootstrap_error = 2 * error;
  return p;
}

Fit osl(double correlation) {
  Fit fit;
  fit.name = "osl";
  fit.parameters = {fitted("eta", 0.6, 0.02), fitted("mu", 0.2, 0.03)};
  fit.correlation.resize(2, 2);
  fit.correlation << 1, correlation, correlation, 1;
  return fit;
}

TEST(DerivedFigures, OfOslGiveItsConstantsBack) {
  const auto figures = derived_figures(osl(0), 28);
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_EQ(figures[0].parameter.name, "K");
  EXPECT_EQ(figures[1].parameter.name, "tau_deg");
  // eta = (K - T^2)/(1 - K T^2), mu = 2 (K + 1) T/(1 - K T^2)
  const double k = figures[0].value, t = std::tan(figures[1].value * kDegree);
  EXPECT_NEAR((k - t * t) / (1 - k * t * t), 0.6, 1e-10);
  EXPECT_NEAR(2 * (k + 1) * t / (1 - k * t * t), 0.2, 1e-10);
}

TEST(DerivedFigures, HaveTheSpreadOfDraws) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (const double r : {-0.8, 0.0, 0.8}) {
    const auto figures = derived_figures(osl(r), 28);
    double sum[2] = {0, 0}, squares[2] = {0, 0};
    constexpr int draws = 20000;
    for (int n = 0; n < draws; ++n) {
      const double one = normal(random), other = r * one + std::sqrt(1 - r * r) * normal(random);
      const auto ratio = continuum::ratio_of({0.6 + 0.02 * one, 0.2 + 0.03 * other});
      const double drawn[2] = {ratio.K, ratio.tau / kDegree};
      for (int k = 0; k < 2; ++k) {
        sum[k] += drawn[k];
        squares[k] += drawn[k] * drawn[k];
      }
    }
    for (int k = 0; k < 2; ++k) {
      const double spread = std::sqrt(squares[k] / draws - sum[k] * sum[k] / draws / draws);
      EXPECT_NEAR(figures[k].error / spread, 1, 0.05) << k << " at correlation " << r;
      EXPECT_NEAR(figures[k].bootstrap_error, 2 * figures[k].error, 1e-9);
    }
  }
}

TEST(DerivedFigures, OfOneFreeNumberHoldEta) {
  Fit fit;
  fit.name = "osl_yield";
  fit.parameters = {fitted("mu", 0.2, 0.03)};
  fit.correlation = Eigen::MatrixXd::Identity(1, 1);
  const auto figures = derived_figures(fit, 28);
  ASSERT_EQ(figures.size(), 3u);
  EXPECT_EQ(figures[2].parameter.name, "eta");
  // eta = eta0 (1 - mu tan phi): linear, so that the error is exact.
  const double more = continuum::eta_at_yield(28 * kDegree, 0.23);
  EXPECT_NEAR(figures[2].value, continuum::eta_at_yield(28 * kDegree, 0.2), 1e-12);
  EXPECT_NEAR(figures[2].error, std::fabs(more - figures[2].value), 1e-9);
}

// Flanks of the theory are in equilibrium; others say by how much they are not.
TEST(DerivedFigures, OfFreeFlanksAreTheirBalance) {
  const double phi = 28 * kDegree, b = std::numbers::pi / 2 - phi;
  Fit fit;
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, double>>{{"a1", 0.3},
                                                   {"a2", 0.5},
                                                   {"b1", -0.2},
                                                   {"a_xx", std::pow(std::sin(b), 2)},
                                                   {"a_yy", 1 + std::pow(std::cos(b), 2)},
                                                   {"a_xy", std::sin(b) * std::cos(b)},
                                                   {"beta_hat_deg", 35}}) {
    fit.parameters.push_back(fitted(name, value, 0.01));
  }
  fit.correlation = Eigen::MatrixXd::Identity(7, 7);
  auto figures = derived_figures(fit, 28);
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_NEAR(figures[0].value, 0, 1e-12);
  EXPECT_NEAR(figures[1].value, 0, 1e-12);
  EXPECT_NEAR(figures[1].error, 0.01 * std::sqrt(1 + std::pow(std::tan(phi), 2)), 1e-8);
  fit.parameters[4].value += 0.3;
  EXPECT_NEAR(derived_figures(fit, 28)[1].value, 0.3, 1e-12);
}

TEST(DerivedFigures, WithoutErrorsHaveNone) {
  Fit fit = osl(0);
  fit.parameters[1].error = fit.parameters[1].covariance_error = fit.parameters[1].bootstrap_error =
      kNan;
  const auto figures = derived_figures(fit, 28);
  EXPECT_TRUE(std::isfinite(figures[0].value));
  EXPECT_TRUE(std::isnan(figures[0].error));
  EXPECT_TRUE(std::isnan(figures[0].bootstrap_error));
  Fit other;
  other.parameters = {fitted("beta_hat_deg", 35, 1)};
  EXPECT_TRUE(derived_figures(other, 28).empty());
}

}  // namespace
}  // namespace grainfield::coupling
