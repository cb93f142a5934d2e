// Few realizations: errors, agreement and the verdict stay honest; parameters at a bound.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/judge/words.h"
#include "tests/coupling/fit_scene.h"

namespace grainfield::coupling {
namespace {

constexpr int kTrials = 100;

FitOptions plain() {
  FitOptions options;
  options.bootstrap = 0;
  return options;
}

const std::vector<FitModel>& models() {
  static const std::vector<FitModel> all = heap_models({kSlope, kRhoG, kHeight});
  return all;
}

// How often the sentence says that no model agrees, and how often
// the intervals of all parameters hold the truth.
struct Tally {
  int none_agrees = 0, inside = 0;
};

Tally tally(int realizations) {
  const FitModel& osl = find_fit_model(models(), "osl");
  const Eigen::VectorXd truth = vector({0.74, -0.31});
  FitData data = places(11);
  const Eigen::VectorXd exact = predict(data, osl, truth);
  dem::Random random(31);
  Tally out;
  for (int trial = 0; trial < kTrials; ++trial) {
    fill(data, exact, realizations, 0.05, 0.03, random);
    const Weights c = weights_of(data);
    const Fit f = fit(data, c, osl, plain());
    bool inside = true;
    for (Eigen::Index k = 0; k < 2; ++k) {
      const FittedParameter& p = f.parameters[static_cast<std::size_t>(k)];
      inside = inside && p.low < truth[k] && truth[k] < p.high;
    }
    out.inside += inside ? 1 : 0;
    out.none_agrees += select(data, c, {osl}, {f}).best_model().agrees() == Answer::no ? 1 : 0;
  }
  return out;
}

TEST(FitWeights, ATrueModelAgreesHoweverFewTheRealizations) {
  for (const int realizations : {2, 3, 4, 8}) {
    const Tally t = tally(realizations);
    EXPECT_GE(t.inside, 88) << realizations;
    EXPECT_LE(t.none_agrees, 4) << realizations;
  }
}

// A truth half-way between two models speaks for neither.
TEST(FitWeights, HalfwayBetweenTwoModelsNeitherIsNamed) {
  const std::vector<FitModel> two{find_fit_model(models(), "cantelaube_minus"),
                                  find_fit_model(models(), "cantelaube_zero")};
  FitData data = places(11);
  const Eigen::VectorXd none(0);
  const Eigen::VectorXd middle = (predict(data, two[0], none) + predict(data, two[1], none)) / 2;
  for (const int realizations : {3, 8}) {
    dem::Random random(5);
    int named = 0;
    for (int trial = 0; trial < 2 * kTrials; ++trial) {
      fill(data, middle, realizations, 0.05, 0.03, random);
      const Weights c = weights_of(data);
      std::vector<Fit> fits;
      for (const FitModel& m : two) fits.push_back(fit(data, c, m, plain()));
      named += select(data, c, two, fits).distinguishable == Answer::yes ? 1 : 0;
    }
    EXPECT_LE(named, 2 * kTrials * 15 / 100) << realizations;
  }
}

// Without errors the fewest parameters would win whatever the residuals.
TEST(FitWeights, OneRealizationIsRankedByItsDistance) {
  const std::vector<FitModel> all{find_fit_model(models(), "hydrostatic"),
                                  find_fit_model(models(), "osl")};
  FitData data = places(11);
  data.samples = predict(data, all[1], vector({0.74, -0.31})) / (kRhoG * kHeight);
  const std::vector<FitModel> scaled = [&] {
    std::vector<FitModel> out = heap_models({kSlope, 1 / kHeight, kHeight});
    return std::vector<FitModel>{find_fit_model(out, "hydrostatic"), find_fit_model(out, "osl")};
  }();
  const Weights c = weights_of(data);
  std::vector<Fit> fits;
  for (const FitModel& m : scaled) fits.push_back(fit(data, c, m, plain()));
  const Judgement s = select(data, c, scaled, fits);
  EXPECT_EQ(s.best, "osl");
  EXPECT_EQ(s.distinguishable, Answer::unknown);
  EXPECT_THAT(sentence(s),
              testing::StartsWith("One realization cannot distinguish models: osl is nearest (0.0 "
                                  "%), then hydrostatic ("));
  EXPECT_TRUE(std::isnan(fits[0].chi2_per_dof));
}

TEST(FitWeights, EqualRealizationsHaveNoSpread) {
  const FitModel& osl = find_fit_model(models(), "osl");
  FitData data = places(9);
  const Eigen::VectorXd one = predict(data, osl, vector({0.74, -0.31}));
  for (const int copies : {2, 3, 8}) {
    data.samples = one.replicate(1, copies);
    const Weights c = weights_of(data);
    EXPECT_FALSE(c.known());
    EXPECT_EQ(c.note, "all " + std::to_string(copies) + " realizations are equal: no errors");
  }
  const std::vector<FitModel> two{find_fit_model(models(), "hydrostatic"), osl};
  std::vector<Fit> fits;
  const Weights c = weights_of(data);
  for (const FitModel& m : two) fits.push_back(fit(data, c, m, plain()));
  const Judgement s = select(data, c, two, fits);
  EXPECT_EQ(s.distinguishable, Answer::unknown);
  EXPECT_EQ(s.best, "osl");
}

// A component that is 0 in every realization (shear of a perfectly even heap) is no exact one.
TEST(FitWeights, AComponentWithoutSpreadDoesNotBreakTheWeights) {
  FitData data = places(9);
  dem::Random random(4);
  fill(data, predict(data, find_fit_model(models(), "osl"), vector({0.74, -0.31})), 5, 0.05, 0.03,
       random);
  for (int k = 0; k < data.values(); ++k) {
    if (data.component[static_cast<std::size_t>(k)] == 2) data.samples.row(k).setZero();
  }
  const FitModel& osl = find_fit_model(models(), "osl");
  const Fit f = fit(data, weights_of(data), osl, plain());
  EXPECT_TRUE(std::isfinite(f.chi2_per_dof));
}

// Constants that no value depends on have no error, and do not take the others' away.
TEST(FitWeights, SigmaXxAloneLeavesTheOtherConstantsOpen) {
  const FitModel& free = find_fit_model(models(), "cantelaube");
  const Eigen::VectorXd truth = vector({0.34, 0.49, -0.2, 0.78, 1.23, 0.38, 35});
  const FitData all = places(15);
  std::vector<int> rows;
  for (int k = 0; k < all.values(); ++k) {
    if (all.component[static_cast<std::size_t>(k)] == 0) rows.push_back(k);
  }
  FitData data = rows_of(all, rows);
  dem::Random random(8);
  fill(data, predict(data, free, truth), 8, 0.02, 0.03, random);
  const Fit f = fit(data, weights_of(data), free, plain());
  for (const FittedParameter& p : f.parameters) {
    const std::string& name = p.parameter.name;
    const bool seen = name == "a2" || name == "a_xx" || name == "beta_hat_deg";
    EXPECT_EQ(p.determined, seen) << name;
    EXPECT_EQ(std::isfinite(p.error), seen) << name;
  }
  EXPECT_THAT(f.note, testing::HasSubstr("the values do not determine a1"));
}

// A line a + b x with b held below the truth: a keeps its error.
TEST(FitWeights, AParameterAtItsBoundLeavesTheOthersTheirErrors) {
  FitModel line;
  line.name = line.label = "line";
  line.parameters = {{"a", "-", "level", -1e9, 1e9}, {"b", "-", "slope", 0, 1}};
  line.starts = {vector({0, 0.5})};
  line.stress = [](const Eigen::MatrixXd& points, const Eigen::VectorXd& p) {
    Eigen::MatrixXd out(points.rows(), 3);
    for (Eigen::Index k = 0; k < points.rows(); ++k) {
      out.row(k).setConstant(p[0] + p[1] * points(k, 0));
    }
    return out;
  };
  line.parameters[0].least = -std::numeric_limits<double>::infinity();
  line.parameters[0].most = std::numeric_limits<double>::infinity();
  FitData data = places(9);
  dem::Random random(2);
  const Eigen::VectorXd truth = 3 + 50 * data.points.col(0).array();
  fill(data, truth, 6, 1e-4, 0.03, random);
  const Weights c = weights_of(data);
  const Fit f = fit(data, c, line, plain());
  EXPECT_TRUE(f.parameters[1].at_bound);
  EXPECT_TRUE(std::isnan(f.parameters[1].error));
  EXPECT_TRUE(std::isfinite(f.parameters[0].error));
  // As if b were no parameter at all.
  FitModel level = line;
  level.parameters.pop_back();
  level.starts = {vector({0})};
  level.stress = [&line](const Eigen::MatrixXd& points, const Eigen::VectorXd& p) {
    return line.stress(points, vector({p[0], 1}));
  };
  const Fit g = fit(data, c, level, plain());
  EXPECT_NEAR(f.parameters[0].error, g.parameters[0].error, 1e-6 * g.parameters[0].error);
  EXPECT_THAT(f.note, testing::HasSubstr("b ends at its bound"));
}

}  // namespace
}  // namespace grainfield::coupling
