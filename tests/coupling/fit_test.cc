// Fits of stress models: known constants come back, weights, errors, bad data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/fit/intervals.h"
#include "tests/coupling/fit_scene.h"

namespace grainfield::coupling {
namespace {

TEST(Fit, WithoutNoiseTheConstantsComeBack) {
  const auto models = heap_models({kSlope, kRhoG, kHeight});
  for (const Truth& truth : truths()) {
    const FitModel& model = find_fit_model(models, truth.model);
    FitData data = places(41);
    data.samples.col(0) = predict(data, model, truth.parameters);
    const Weights weights = weights_of(data);
    EXPECT_FALSE(weights.known());
    const Fit f = fit(data, weights, model);
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
    const Fit f = fit(data, weights_of(data), model);
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

// The weights are fixed: other realizations, more of them, or louder ones change nothing.
TEST(Fit, WeightsDoNotDependOnTheEnsemble) {
  dem::Random random(5);
  FitData data = places(9);
  data.scale = Eigen::VectorXd::LinSpaced(data.values(), 1, 3);
  Eigen::VectorXd first;
  for (const int realizations : {1, 2, 4, 16}) {
    fill(data, Eigen::VectorXd::Zero(data.values()), realizations, 0.1 * realizations, 0.03,
         random);
    const Weights w = weights_of(data);
    if (first.size() == 0) first = w.weight;
    EXPECT_EQ((w.weight - first).norm(), 0);
    EXPECT_EQ(w.errors_from == ErrorsFrom::realizations, realizations > 1);
    if (realizations < 16) continue;
    EXPECT_NEAR(w.error.mean(), 1.6 * kRhoG * kHeight / 4, 0.15 * 1.6 * kRhoG * kHeight / 4);
  }
  EXPECT_NEAR(first[0], 1, 1e-12);
  EXPECT_NEAR(first[first.size() - 1], 1.0 / 3, 1e-12);
}

// A straight line with its level free: the mean over all values, whose error over realizations is
// exact, and so are the jackknife's and the sandwich's.
TEST(Fit, ErrorsOfALinearConstantAreThoseOfItsRealizations) {
  FitModel level;
  level.name = level.label = "level";
  const double far = std::numeric_limits<double>::infinity();
  level.parameters = {{"a", "-", "level", -far, far}};
  level.starts = {vector({0})};
  level.stress = [](const Eigen::MatrixXd& points, const Eigen::VectorXd& p) {
    return Eigen::MatrixXd::Constant(points.rows(), 3, p[0]);
  };
  dem::Random random(8);
  FitData data = places(9);
  for (const int realizations : {3, 5, 12}) {
    fill(data, Eigen::VectorXd::Constant(data.values(), 7), realizations, 1e-3, 0.03, random);
    const Eigen::VectorXd each = data.samples.colwise().mean();
    const double n = realizations;
    const double error = std::sqrt((each.array() - each.mean()).square().sum() / (n * (n - 1)));
    const FittedParameter p = fit(data, weights_of(data), level).parameters.front();
    EXPECT_NEAR(p.value, each.mean(), 1e-6);
    EXPECT_NEAR(p.covariance_error, error, 1e-5 * error);
    EXPECT_NEAR(p.jackknife_error, error, 1e-4 * error);
    EXPECT_NEAR(p.error, error, 1e-4 * error);
    EXPECT_NEAR(p.by_profile.high - p.by_profile.low, p.high - p.low, 0.03 * (p.high - p.low));
  }
}

// A ratio of moduli along x over y says the same as that along y over x.
TEST(Fit, IntervalOfARatioIsThatOfItsReciprocal) {
  const Eigen::VectorXd left_out = vector({2.1, 1.4, 3.3, 1.9, 2.6});
  const Interval one = interval_above(0, 2.2, left_out, 2.776);
  const Interval other = interval_above(0, 1 / 2.2, left_out.cwiseInverse(), 2.776);
  EXPECT_NEAR(other.low, 1 / one.high, 1e-12);
  EXPECT_NEAR(other.high, 1 / one.low, 1e-12);
  EXPECT_GT(one.low, 0);
  // Far from its limit it is the plain one.
  const double error = jackknife_error(left_out);
  const Interval far = interval_above(-1e6, 2.2, left_out, 2.776);
  EXPECT_NEAR(far.low, 2.2 - 2.776 * error, 1e-4);
  EXPECT_NEAR(far.high, 2.2 + 2.776 * error, 1e-4);
}

TEST(Fit, BadData) {
  FitData data = places(5);
  data.samples.setZero();
  data.components[0] = "pressure";
  EXPECT_THROW(weights_of(data), std::invalid_argument);
  data = places(5);
  data.samples.setConstant(std::nan(""));
  EXPECT_THROW(weights_of(data), std::invalid_argument);
  EXPECT_THROW(find_fit_model(heap_models({}), "jansen"), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::coupling
