// Fits of stress models: known constants come back, weights, errors, bad data.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "coupling/fit/coverage.h"
#include "coupling/fit/intervals.h"
#include "tests/coupling/fit_scene.h"

namespace grainfield::coupling {
namespace {

using testing::HasSubstr;
using testing::Not;

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
  EXPECT_EQ(find_fit_model(heap_models({75, kRhoG, kHeight}), "cantelaube").absent,
            "flanks of 75.0 degrees leave no room for a core");
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

// One constant a and stresses of it alone, the same everywhere; -2 to 2.
FitModel of_one(const std::function<Eigen::RowVector3d(double)>& stress) {
  FitModel out;
  out.name = out.label = "one";
  out.parameters = {{"a", "-", "", -2, 2}};
  out.starts = {vector({0.5}), vector({-0.5})};
  out.stress = [stress](const Eigen::MatrixXd& points, const Eigen::VectorXd& p) {
    return Eigen::MatrixXd(stress(p[0]).replicate(points.rows(), 1));
  };
  return out;
}

// xx = a^2 is as good with -a; yy = 0.01 a, for 0.01 there, hardly tells them apart.
TEST(Fit, ASecondMinimumWithinTheNoiseIsReportedWithItsConstants) {
  const FitModel square = of_one([](double a) { return Eigen::RowVector3d(a * a, 0.01 * a, 0); });
  FitData data = places(9);
  const Eigen::VectorXd exact = predict(data, square, vector({1}));
  const auto fitted = [&](double noise) {
    dem::Random random(3);
    fill(data, exact, 6, noise / (kRhoG * kHeight), 0.03, random);
    FitOptions options;
    options.bootstrap = 0;
    return fit(data, weights_of(data), square, options);
  };
  const Fit loud = fitted(0.3), still = fitted(1e-4);
  ASSERT_EQ(loud.other_minima.size(), 1U);
  const double best = loud.parameters[0].value, other = loud.other_minima[0][0];
  EXPECT_NEAR(std::fabs(best), 1, 0.1);
  EXPECT_NEAR(other, -best, 0.1);
  EXPECT_THAT(loud.note,
              HasSubstr(fmt::format("as likely within the noise: a = {:.3g} (misfit ", other)));
  EXPECT_NEAR(still.parameters[0].value, 1, 1e-3);
  EXPECT_TRUE(still.other_minima.empty());
  EXPECT_EQ(still.note, "");
}

// All realizations agree on a, and differ only where a has no say: no error of 0, and it is said.
TEST(Fit, AConstantThatAllRealizationsShareHasNoError) {
  const FitModel level = of_one([](double a) { return Eigen::RowVector3d(a, 0, 0); });
  FitData data = places(9);
  dem::Random random(4);
  fill(data, Eigen::VectorXd::Zero(data.values()), 5, 0.1 / (kRhoG * kHeight), 0.03, random);
  for (int k = 0; k < data.values(); ++k) {
    if (data.component[static_cast<std::size_t>(k)] == 0) data.samples.row(k).setConstant(0.7);
  }
  const Fit f = fit(data, weights_of(data), level);
  const FittedParameter& a = f.parameters[0];
  EXPECT_NEAR(a.value, 0.7, 1e-6);
  for (const double error : {a.error, a.covariance_error, a.jackknife_error, a.bootstrap_error}) {
    EXPECT_TRUE(std::isnan(error)) << error;
  }
  EXPECT_TRUE(std::isnan(a.low) && std::isnan(a.high));
  EXPECT_THAT(f.note, HasSubstr("a is the same for all realizations: no error"));
}

// Every draw that counts counts once, and those of other sizes not at all.
TEST(Fit, CoverageIsPooledOverTheConstants) {
  const auto constant = [](const char* name, int size, int draws, double share) {
    ConstantCoverage out;
    out.model = "osl";
    out.parameter = name;
    out.size = size;
    out.draws = draws;
    out.by_covariance = out.by_jackknife = share;
    out.by_bootstrap = out.by_profile = std::nan("");
    return out;
  };
  Coverage coverage;
  coverage.constants = {constant("eta", 4, 10, 0.8), constant("mu", 4, 30, 1),
                        constant("nu", 4, 0, std::nan("")), constant("eta", 8, 20, 0.5)};
  coverage.verdicts = {{4, 30}, {8, 20}, {16, 20}};
  const std::string text = coverage_text(coverage, 16);
  EXPECT_THAT(
      text,
      HasSubstr(
          "| all   |          | 4     | 40    | 95.0 %     | -         | 95.0 %    | -       |"));
  EXPECT_THAT(
      text,
      HasSubstr(
          "| all   |          | 8     | 20    | 50.0 %     | -         | 50.0 %    | -       |"));
  EXPECT_THAT(text, Not(HasSubstr("| all   |          | 16 ")));
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
