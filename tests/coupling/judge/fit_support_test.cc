// Which models count as supported: the rule on made-up scores, and errors that a field brings.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/judge/words.h"
#include "tests/coupling/fit_scene.h"

namespace grainfield::coupling {
namespace {

JudgedModel score(double heights, double behind, double error) {
  JudgedModel s;
  s.heights_behind = heights;
  s.behind = behind;
  s.behind_error = error;
  return s;
}

// Marks of models that are far apart.
void mark(std::vector<JudgedModel>& ranking) {
  mark_distinguishable(ranking, std::vector<double>(ranking.size(), 1e9), 2);
}
bool kept(const JudgedModel& m) { return m.distinguishable == Answer::no; }

std::vector<Fit> fits_of(const FitData& data, const Weights& weights,
                         const std::vector<FitModel>& models) {
  FitOptions options;
  options.bootstrap = 0;
  std::vector<Fit> out;
  for (const FitModel& m : models) out.push_back(fit(data, weights, m, options));
  return out;
}

TEST(Support, ALargerDeficitWithALargerErrorIsNoBetter) {
  std::vector<JudgedModel> ranking{score(0, 0, 0), score(0.02, 0.034, 0.014),
                                   score(0.03, 0.098, 0.052)};
  mark(ranking);
  EXPECT_TRUE(kept(ranking[0]));
  EXPECT_FALSE(kept(ranking[1]));
  EXPECT_FALSE(kept(ranking[2]));
}

TEST(Support, WhatIsAheadInOneJudgeStays) {
  std::vector<JudgedModel> ranking{score(0, 0, 0), score(0.1, 0.1, 0.01), score(-0.1, 0.2, 0.01)};
  mark(ranking);
  EXPECT_FALSE(kept(ranking[1]));
  EXPECT_TRUE(kept(ranking[2]));
  // Without scores nothing is left out.
  const double none = std::nan("");
  ranking = {score(none, none, none), score(none, none, none)};
  mark(ranking);
  EXPECT_TRUE(kept(ranking[1]));
}

TEST(Support, NoModelIsSupportedThatDisagrees) {
  JudgedModel m = score(0, 0, 0);
  m.misfit = 3;
  m.chance = 2;
  m.distinguishable = Answer::no;
  EXPECT_EQ(m.supported(), Answer::no);
  m.misfit = 2;
  EXPECT_EQ(m.supported(), Answer::yes);
  m.distinguishable = Answer::yes;
  EXPECT_EQ(m.supported(), Answer::no);
  m.distinguishable = Answer::no;
  m.description = true;
  EXPECT_EQ(m.supported(), Answer::no);
  m.misfit = m.chance = std::nan("");  // nothing is known of errors
  EXPECT_EQ(m.supported(), Answer::unknown);
}

// The models are further apart than the noise, or the nearer one is not named.
TEST(Support, CurvesThatHardlyDifferAreNotDistinguished) {
  std::vector<JudgedModel> ranking{score(0, 0, 0), score(0, 0.1, 0.01)};
  mark_distinguishable(ranking, {0, 0.0101}, 2);
  EXPECT_FALSE(kept(ranking[1]));
  mark_distinguishable(ranking, {0, 0.0099}, 2);
  EXPECT_TRUE(kept(ranking[1]));
}

// Constants without equilibrium follow the noise best, and are listed last.
TEST(Support, ADescriptionWinsNoVerdict) {
  const auto all = heap_models({kSlope, kRhoG, kHeight});
  const std::vector<FitModel> models{find_fit_model(all, "cantelaube"),
                                     find_fit_model(all, "hydrostatic")};
  FitData data = places(9);
  dem::Random random(5);
  fill(data, predict(data, find_fit_model(all, "cantelaube_minus"), Eigen::VectorXd(0)), 8, 0.03,
       0.03, random);
  const Weights w = weights_of(data);
  const Judgement j = select(data, w, models, fits_of(data, w, models));
  EXPECT_EQ(j.best, "hydrostatic");
  EXPECT_EQ(j.models.back().name, "cantelaube");
  EXPECT_LT(j.models.back().score, j.models.front().score);
}

// The best of wrong models is not passed off as right.
TEST(Support, SaysWhenNoModelAgrees) {
  const auto all = heap_models({kSlope, kRhoG, kHeight});
  const std::vector<FitModel> minus{find_fit_model(all, "cantelaube_minus")},
      wrong{find_fit_model(all, "hydrostatic")};
  dem::Random random(5);
  FitData data = places(9);
  fill(data, predict(data, minus[0], Eigen::VectorXd(0)), 8, 0.03, 0.03, random);
  const Weights c = weights_of(data);
  const auto sentence = [&](const std::vector<FitModel>& models) {
    return coupling::sentence(select(data, c, models, fits_of(data, c, models)));
  };
  EXPECT_THAT(sentence(minus),
              testing::StartsWith("cantelaube_minus agrees with the grains (8 realizations, 95 %). "
                                  "cantelaube_minus agrees within the errors: misfit "));
  EXPECT_THAT(sentence(wrong),
              testing::StartsWith("No model describes the grains: the nearest, hydrostatic, misses "
                                  "by 52 % (8 realizations). No model agrees within the errors: "));
}

TEST(Support, NoSupportedModelIsFurtherBehindInBothThanOneThatIsNot) {
  dem::Random random(3);
  int refused = 0, left = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<JudgedModel> ranking{score(0, 0, 0)};
    const int models = 1 + static_cast<int>(8 * random.uniform());
    for (int k = 0; k < models; ++k) {
      // Ties are in: deficits in whole steps.
      ranking.push_back(score(std::floor(10 * random.uniform(-0.3, 1)) / 10,
                              std::floor(10 * random.uniform()) / 10, 0.3 * random.uniform()));
    }
    mark(ranking);
    EXPECT_TRUE(kept(ranking.front()));
    for (const JudgedModel& s : ranking) {
      (kept(s) ? left : refused) += 1;
      for (const JudgedModel& other : ranking) {
        if (&s == &ranking.front() || !kept(s) || kept(other)) continue;
        EXPECT_TRUE(s.heights_behind < other.heights_behind || s.behind < other.behind);
      }
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(left, 1000);
}

// bcc and cantelaube_zero are one field, osl_yield and cantelaube_continuous one family: what is
// left of their difference is rounding, of whatever grains.
TEST(Support, ModelsThatAreOneFieldShareTheirMark) {
  const auto all = heap_models({kSlope, kRhoG, kHeight});
  const std::vector<std::string> names{"bcc", "cantelaube_zero", "osl_yield",
                                       "cantelaube_continuous", "hydrostatic"};
  std::vector<FitModel> models;
  for (const std::string& name : names) models.push_back(find_fit_model(all, name));
  int refused = 0, left = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    dem::Random random(seed);
    FitData data = places(9);
    const Eigen::VectorXd truth =
        random.uniform(0, 1) * predict(data, models[0], Eigen::VectorXd(0)) +
        random.uniform(0, 1) * predict(data, models[4], Eigen::VectorXd(0));
    fill(data, truth, 8, 0.05, 0.03, random);
    const Weights w = weights_of(data);
    const std::vector<FitModel> two{models[0], models[1]};
    const Judgement alone = select(data, w, two, fits_of(data, w, two));
    EXPECT_EQ(alone.distinguishable, Answer::no) << sentence(alone);
    EXPECT_TRUE(alone.find(alone.rival)->power.same);
    EXPECT_THAT(note_lines(alone).back(), testing::HasSubstr("they are the same stress here"));
    const Judgement s = select(data, w, models, fits_of(data, w, models));
    const auto marked = [&](const std::string& name) { return kept(*s.find(name)); };
    EXPECT_EQ(marked("bcc"), marked("cantelaube_zero")) << sentence(s);
    EXPECT_EQ(marked("osl_yield"), marked("cantelaube_continuous")) << sentence(s);
    for (const JudgedModel& one : s.models) (kept(one) ? left : refused) += 1;
  }
  EXPECT_GT(refused, 20);
  EXPECT_GT(left, 20);
}

// One field alone, whose errors are known: a model far off is excluded, one within them is not.
TEST(Support, OneFieldWithErrorsExcludesAModel) {
  const auto all = heap_models({kSlope, kRhoG, kHeight});
  const std::vector<FitModel> models{find_fit_model(all, "osl_yield"),
                                     find_fit_model(all, "hydrostatic"),
                                     find_fit_model(all, "cantelaube_minus")};
  FitData data = places(11);
  const Eigen::VectorXd truth = predict(data, models[0], vector({-0.3}));
  dem::Random random(9);
  int named = 0, alarms = 0, named_in_noise = 0;
  for (int trial = 0; trial < 100; ++trial) {
    for (const double noise : {0.02, 0.6}) {
      fill(data, truth, 1, noise, 0.03, random);
      data.error = Eigen::VectorXd::Constant(data.values(), noise * kRhoG * kHeight);
      const Weights w = weights_of(data);
      const std::vector<Fit> fits = fits_of(data, w, models);
      const Judgement s = select(data, w, models, fits);
      const bool alone = s.distinguishable == Answer::yes && s.best == "osl_yield";
      (noise < 0.1 ? named : named_in_noise) += alone ? 1 : 0;
      alarms += s.best_model().agrees() == Answer::no ? 1 : 0;
      if (noise < 0.1) {
        const Judgement wrong = select(data, w, {models[1]}, {fits[1]});
        EXPECT_THAT(sentence(wrong), testing::HasSubstr("(one field with errors, 95 %)"));
        EXPECT_GT(fits[1].chi2_per_dof, fits[1].chance);
        EXPECT_TRUE(std::isfinite(fits[0].parameters[0].error));
      }
    }
  }
  EXPECT_GE(named, 95);
  EXPECT_LE(named_in_noise, 5);
  EXPECT_LE(alarms, 6);
}

TEST(Support, OneFieldNeedsAkaikesDifferenceToo) {
  std::vector<JudgedModel> ranking{score(0, 0, 0), score(0, 0.1, 0.01), score(0, 0.2, 0.01)};
  ranking[0].aic_behind = 0;
  ranking[1].aic_behind = kNoSupport;
  ranking[2].aic_behind = 1.01 * kNoSupport;
  mark(ranking);
  EXPECT_TRUE(kept(ranking[1]));
  EXPECT_FALSE(kept(ranking[2]));
}

// The constants follow the noise that judges them: models that nearly agree with one another are
// not told apart by it.
TEST(Support, OneFieldOfATrueModelDoesNotExcludeIt) {
  const auto all = heap_models({kSlope, kRhoG, kHeight});
  const std::vector<FitModel> models{find_fit_model(all, "osl"),
                                     find_fit_model(all, "cantelaube_continuous"),
                                     find_fit_model(all, "cantelaube")};
  FitData data = places(11);
  const Eigen::VectorXd truth = predict(data, models[0], vector({0.74, -0.31}));
  dem::Random random(11);
  int wrong = 0, others = 0;
  for (int trial = 0; trial < 60; ++trial) {
    fill(data, truth, 1, 0.05, 1e-6, random);
    data.error = Eigen::VectorXd::Constant(data.values(), 0.05 * kRhoG * kHeight);
    const Weights w = weights_of(data);
    const Judgement s = select(data, w, models, fits_of(data, w, models));
    for (const JudgedModel& one : s.models) {
      if (!kept(one)) (one.name == "osl" ? wrong : others) += 1;
    }
  }
  fmt::print("one field of osl: it is excluded {} times of 60, others {} times\n", wrong, others);
  EXPECT_LE(wrong, 1);
}

TEST(Support, ErrorsOfTheMeanStandInForRealizations) {
  FitData data = places(9);
  data.samples.setConstant(1);
  data.error = Eigen::VectorXd::Constant(data.values(), 0.1);
  const Weights c = weights_of(data);
  EXPECT_EQ(c.errors_from, ErrorsFrom::data);
  EXPECT_NE(c.note.find("single realizations unknown"), std::string::npos);
  EXPECT_NEAR(c.error[0], 0.1, 1e-15);
  data.error[3] = 0;
  EXPECT_THROW(weights_of(data), std::invalid_argument);
}

// Without one of the piles the constant has the other sign: the verdict says so.
TEST(Support, SaysWhoseSignHangsOnOneRealization) {
  const auto all = heap_models({kSlope, kRhoG, kHeight});
  const std::vector<FitModel> models{find_fit_model(all, "osl_yield")};
  FitData data = places(11);
  const auto at = [&](double mu) { return predict(data, models[0], vector({mu})); };
  data.samples.resize(data.values(), 4);
  data.samples << at(0.05), at(0.06), at(0.04), at(-0.3);
  const Weights w = weights_of(data);
  const Judgement s = select(data, w, models, {fit(data, w, models[0])});
  ASSERT_EQ(s.doubts.size(), 1U);
  EXPECT_THAT(s.doubts[0],
              testing::HasSubstr("The sign of osl_yield hangs on single realizations: mu is -0.0"));
  EXPECT_THAT(s.doubts[0], testing::HasSubstr("without realization 4 +0.05"));
}

}  // namespace
}  // namespace grainfield::coupling
