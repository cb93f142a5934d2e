// Which models count as supported: the rule on made-up scores, and errors that a field brings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/coupling/fit_scene.h"

namespace grainfield::coupling {
namespace {

Score score(double aicc, double behind, double error) {
  Score s;
  s.aicc_difference = aicc;
  s.behind = behind;
  s.behind_error = error;
  return s;
}

TEST(Support, ALargerDeficitWithALargerErrorIsNoBetter) {
  // The point-source piles: OSL's 0.034 +- 0.014, one angle's 0.098 +- 0.052.
  std::vector<Score> ranking{score(0, 0, 0), score(94, 0.034, 0.014), score(281, 0.098, 0.052)};
  ranking[1].name = "osl";
  ranking[2].name = "cantelaube_continuous";
  mark_supported(ranking, 6, 2);
  EXPECT_TRUE(ranking[0].supported);
  EXPECT_FALSE(ranking[1].supported);
  EXPECT_FALSE(ranking[2].supported);
}

TEST(Support, WhatIsAheadInOneJudgeStays) {
  std::vector<Score> ranking{score(0, 0, 0), score(20, 0.1, 0.01), score(30, -0.02, 0.05)};
  mark_supported(ranking, 6, 2);
  EXPECT_FALSE(ranking[1].supported);
  EXPECT_TRUE(ranking[2].supported);
  // Without cross-validation nothing is left out.
  ranking = {score(0, std::nan(""), std::nan("")), score(90, std::nan(""), std::nan(""))};
  mark_supported(ranking, 6, 2);
  EXPECT_TRUE(ranking[1].supported);
}

// The best of wrong models is not passed off as right.
TEST(Support, SaysWhenNoModelAgrees) {
  const auto all = heap_models({kSlope, kRhoG, kHeight});
  const std::vector<FitModel> minus{find_fit_model(all, "cantelaube_minus")},
      wrong{find_fit_model(all, "hydrostatic")};
  dem::Random random(5);
  FitData data = places(9);
  fill(data, predict(data, minus[0], Eigen::VectorXd(0)), 8, 0.03, 0.03, random);
  const Covariance c = covariance_of(data);
  FitOptions options;
  options.bootstrap = 0;
  const auto sentence = [&](const std::vector<FitModel>& models) {
    std::vector<Fit> fits;
    for (const FitModel& m : models) fits.push_back(fit(data, c, m, options));
    return select(data, c, models, fits).sentence;
  };
  EXPECT_EQ(sentence(minus), "cantelaube_minus is the only model.");
  EXPECT_EQ(sentence(wrong).find("hydrostatic is the only model. No model agrees within the "
                                 "errors: the nearest has chi2/dof "),
            0U)
      << sentence(wrong);
}

TEST(Support, NoSupportedModelIsFurtherBehindInBothThanOneThatIsNot) {
  dem::Random random(3);
  int refused = 0, kept = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<Score> ranking{score(0, 0, 0)};
    const int models = 1 + static_cast<int>(8 * random.uniform());
    for (int k = 0; k < models; ++k) {
      // Ties are in: deficits in whole steps.
      ranking.push_back(score(std::floor(30 * random.uniform()),
                              std::floor(10 * random.uniform(-0.3, 1)) / 10,
                              0.3 * random.uniform()));
    }
    std::stable_sort(ranking.begin(), ranking.end(), [](const Score& a, const Score& b) {
      return a.aicc_difference < b.aicc_difference;
    });
    std::rotate(ranking.begin(),
                std::find_if(ranking.begin(), ranking.end(),
                             [](const Score& s) { return s.behind_error == 0; }),
                ranking.end());
    for (std::size_t k = 0; k < ranking.size(); ++k) ranking[k].name = std::to_string(k);
    mark_supported(ranking, 6, 2);
    EXPECT_TRUE(ranking.front().supported);
    for (const Score& s : ranking) {
      (s.supported ? kept : refused) += 1;
      for (const Score& other : ranking) {
        if (&other == &ranking.front() || !s.supported || other.supported) continue;
        EXPECT_TRUE(s.aicc_difference < other.aicc_difference || s.behind < other.behind ||
                    &s == &ranking.front());
      }
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(kept, 1000);
}

TEST(Support, ErrorsOfTheMeanStandInForRealizations) {
  FitData data = places(9);
  data.samples.setConstant(1);
  data.error = Eigen::VectorXd::Constant(data.values(), 0.1);
  const Covariance c = covariance_of(data);
  EXPECT_EQ(c.kind, "diagonal");
  EXPECT_NE(c.note.find("single realizations unknown (a parametric covariance needs 3)"),
            std::string::npos);
  EXPECT_NEAR(c.of_mean(0, 0), 0.01, 1e-15);
  data.error[3] = 0;
  EXPECT_THROW(covariance_of(data), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::coupling
