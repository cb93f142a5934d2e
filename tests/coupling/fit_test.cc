// Fits of stress models: known constants come back, covariance, bad data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/coupling/fit_scene.h"

namespace grainfield::coupling {
namespace {

TEST(Fit, WithoutNoiseTheConstantsComeBack) {
  const auto models = heap_models({kSlope, kRhoG, kHeight});
  for (const Truth& truth : truths()) {
    const FitModel& model = find_fit_model(models, truth.model);
    FitData data = places(41);
    data.samples.col(0) = predict(data, model, truth.parameters);
    const Covariance covariance = covariance_of(data);
    EXPECT_EQ(covariance.kind, "unknown");
    const Fit f = fit(data, covariance, model);
    EXPECT_LT(f.rel_l2, 1e-3) << truth.model;
    for (std::size_t k = 0; k < f.parameters.size(); ++k) {
      EXPECT_NEAR(f.parameters[k].value, truth.parameters[k],
                  1e-2 * (1 + std::fabs(truth.parameters[k])))
          << truth.model << " " << f.parameters[k].parameter.name;
      EXPECT_TRUE(std::isnan(f.parameters[k].error));
    }
  }
}

TEST(Fit, CovarianceFindsSizeAndLengthOfTheNoise) {
  dem::Random random(5);
  FitData data = places(25);
  double length = 0, error = 0;
  for (int trial = 0; trial < 20; ++trial) {
    fill(data, Eigen::VectorXd::Zero(data.values()), 10, 0.1, 0.03, random);
    const Covariance c = covariance_of(data);
    EXPECT_EQ(c.kind, "parametric");
    length += c.correlation_length / 20;
    error += c.of_mean.diagonal().mean() / 20;
  }
  // Matern's length that is nearest to a Gaussian of 0.03 m.
  EXPECT_GT(length, 0.02);
  EXPECT_LT(length, 0.08);
  EXPECT_NEAR(std::sqrt(error), 0.1 * kRhoG * kHeight / std::sqrt(10),
              0.05 * kRhoG * kHeight * 0.1);
}

TEST(Fit, FallsBackWithANote) {
  dem::Random random(6);
  FitData data = places(9);
  fill(data, Eigen::VectorXd::Zero(data.values()), 5, 0.1, 0.03, random);
  EXPECT_THAT(covariance_of(data, "sample").note,
              testing::HasSubstr("sample covariance of 81 values needs 84 realizations, found 5"));
  EXPECT_EQ(covariance_of(data, "sample").kind, "parametric");
  EXPECT_EQ(covariance_of(data, "diagonal").kind, "diagonal");
  EXPECT_LT(covariance_of(data, "diagonal").effective_values, 81);
  fill(data, Eigen::VectorXd::Zero(data.values()), 2, 0.1, 0.03, random);
  EXPECT_EQ(covariance_of(data).kind, "diagonal");
  EXPECT_THAT(covariance_of(data).note, testing::HasSubstr("needs 3 realizations, found 2"));
  EXPECT_THROW(covariance_of(data, "full"), std::invalid_argument);
  fill(data, Eigen::VectorXd::Zero(data.values()), 100, 0.1, 0.03, random);
  EXPECT_EQ(covariance_of(data, "sample").kind, "sample");
}

TEST(Fit, BadData) {
  FitData data = places(5);
  data.samples.setZero();
  data.components[0] = "pressure";
  EXPECT_THROW(covariance_of(data), std::invalid_argument);
  data = places(5);
  data.samples.setConstant(std::nan(""));
  EXPECT_THROW(covariance_of(data), std::invalid_argument);
  EXPECT_THROW(find_fit_model(heap_models({}), "jansen"), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::coupling
