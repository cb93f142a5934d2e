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

TEST(Fit, WithoutNoiseTheConstantsOfTwoSlopesComeBack) {
  const auto models = heap_models(two_slopes());
  for (const Truth& truth : two_sided_truths()) {
    const FitModel& model = find_fit_model(models, truth.model);
    EXPECT_EQ(model.absent, "");
    FitData data = places(31, kLeft, kRight);
    int outside = 0;
    data.samples.col(0) = predict(data, model, truth.parameters, &outside);
    ASSERT_EQ(outside, 0) << truth.model;
    const Fit f = fit(data, covariance_of(data), model);
    EXPECT_LT(f.rel_l2, 1e-4) << truth.model;
    for (std::size_t k = 0; k < f.parameters.size(); ++k) {
      EXPECT_NEAR(f.parameters[k].value, truth.parameters[k],
                  5e-3 * (1 + std::fabs(truth.parameters[k])))
          << truth.model << " " << f.parameters[k].parameter.name;
    }
  }
}

// Equal slopes at the friction angle: the theory with two slopes is Cantelaube's.
TEST(Fit, TwoEqualSlopesGiveTheSymmetricTheory) {
  const auto models = heap_models({kSlope, kRhoG, kHeight});
  FitData data = places(21);
  data.samples.setZero();
  const auto at = [&](const std::string& name) {
    const FitModel& model = find_fit_model(models, name);
    Eigen::VectorXd p(static_cast<Eigen::Index>(model.parameters.size()));
    if (p.size() == 1) p[0] = 0;  // the vertical ray
    return predict(data, model, p);
  };
  for (const char* branch : {"_zero", "_plus"}) {
    const Eigen::VectorXd one = at(std::string("cantelaube") + branch);
    const Eigen::VectorXd two = at(std::string("cantelaube_asymmetric") + branch);
    EXPECT_LT((one - two).norm(), 1e-6 * one.norm()) << branch;
  }
}

// A heap with flanks so far apart that no core yields with a dip: the model is absent, and said so.
TEST(Fit, ModelsThatDoNotExistSayWhy) {
  HeapFacts facts = two_slopes();
  facts.left_deg = 31;
  facts.right_deg = 8;
  int absent = 0;
  for (const FitModel& model : heap_models(facts)) absent += model.absent.empty() ? 0 : 1;
  for (const FitModel& model : heap_models(facts)) {
    if (model.absent.empty()) continue;
    EXPECT_NE(model.absent.find("between flanks of 31.0 and 8.0 degrees"), std::string::npos);
  }
  EXPECT_LE(absent, 2);
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

// 2 e E1(1) for two degrees of freedom: x is then exponential.
TEST(Fit, BiasOfTheInverseVariance) {
  EXPECT_NEAR(inverse_bias(3), 1.1926947246, 1e-8);
  // Mean of 2/(1 + z^2), z normal.
  EXPECT_NEAR(inverse_bias(2),
              2 * std::sqrt(std::numbers::pi / 2) * std::exp(0.5) * std::erfc(std::sqrt(0.5)),
              1e-6);
  EXPECT_LT(inverse_bias(8), 1.075);
  EXPECT_GT(inverse_bias(8), 1.05);
  EXPECT_NEAR(inverse_bias(1000), 1, 1e-3);
  EXPECT_THROW(inverse_bias(1), std::invalid_argument);
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
