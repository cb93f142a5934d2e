// Over 100 synthetic ensembles: intervals hold the truth, and the choice between models names the
// one that made the data.
#include <gtest/gtest.h>

#include "tests/coupling/fit_scene.h"

namespace grainfield::coupling {
namespace {

// Of 100 ensembles of 8 piles the 95 % intervals hold the truth in at least 90.
void expect_coverage(const std::vector<FitModel>& models, const std::vector<Truth>& all,
                     FitData data, std::uint64_t seed) {
  dem::Random random(seed);
  for (const Truth& truth : all) {
    const FitModel& model = find_fit_model(models, truth.model);
    const Eigen::VectorXd exact = predict(data, model, truth.parameters);
    std::vector<int> inside(model.parameters.size(), 0);
    for (int trial = 0; trial < 100; ++trial) {
      fill(data, exact, 8, 0.05, 0.03, random);
      FitOptions options;
      options.bootstrap = 0;
      const Fit f = fit(data, covariance_of(data), model, options);
      for (std::size_t k = 0; k < inside.size(); ++k) {
        inside[k] +=
            f.parameters[k].low < truth.parameters[k] && truth.parameters[k] < f.parameters[k].high;
      }
    }
    for (std::size_t k = 0; k < inside.size(); ++k) {
      EXPECT_GE(inside[k], 90) << truth.model << " " << model.parameters[k].name;
    }
  }
}

TEST(Fit, IntervalsCoverTheTruth) {
  expect_coverage(heap_models({kSlope, kRhoG, kHeight}), truths(), places(15), 11);
}

TEST(Fit, IntervalsCoverTheTruthOfTwoSlopes) {
  expect_coverage(heap_models(two_slopes()), two_sided_truths(), places(15, kLeft, kRight), 21);
}

// Of 100 ensembles at least 95 name the model that made them; with an effect far below the noise
// hardly any does.
TEST(Fit, SelectionNamesTheModelThatMadeTheData) {
  const auto all = heap_models({kSlope, kRhoG, kHeight});
  const std::vector<FitModel> models{
      find_fit_model(all, "cantelaube_minus"), find_fit_model(all, "cantelaube_plus"),
      find_fit_model(all, "osl_yield"), find_fit_model(all, "hydrostatic")};
  dem::Random random(12);
  FitData data = places(11);
  FitOptions options;
  options.bootstrap = 0;
  const auto wins = [&](const Eigen::VectorXd& exact, double noise, const std::string& name) {
    int named = 0;
    for (int trial = 0; trial < 100; ++trial) {
      fill(data, exact, 8, noise, 0.03, random);
      const Covariance c = covariance_of(data);
      std::vector<Fit> fits;
      for (const FitModel& m : models) fits.push_back(fit(data, c, m, options));
      const Selection s = select(data, c, models, fits);
      named += s.distinguishable && s.ranking.front().name == name;
    }
    return named;
  };
  const Eigen::VectorXd minus = predict(data, models[0], Eigen::VectorXd(0));
  const Eigen::VectorXd osl = predict(data, models[2], vector({-0.3}));
  EXPECT_GE(wins(minus, 0.03, "cantelaube_minus"), 95);
  EXPECT_GE(wins(osl, 0.03, "osl_yield"), 95);
  EXPECT_LE(wins(minus, 2, "cantelaube_minus"), 5);
}

}  // namespace
}  // namespace grainfield::coupling
