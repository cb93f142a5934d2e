// Over 100 synthetic ensembles: intervals hold the truth, and the choice between models names the
// one that made the data.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coupling/fit/coverage.h"
#include "coupling/models/observation_operator.h"
#include "tests/coupling/fit_scene.h"

namespace grainfield::coupling {
namespace {

// Width of the averaging's kernel, m: points lie about half an independent length apart.
constexpr double kWidth = 0.018;

std::vector<FitModel> seen(const std::vector<FitModel>& models, const FitData& data) {
  const Eigen::MatrixXd places = places_of(data);
  const auto seeing = std::make_shared<const HeapSight>(HeapSight{
      Places(places), ObservationOperator::of_heap(places, *make_kernel("lucy", kWidth), kHeight)});
  std::vector<FitModel> out;
  for (const FitModel& model : models) out.push_back(seen_through(model, seeing));
  return out;
}

// The 95 % intervals of 100 ensembles of 8 piles, with noise as grains have it, hold the truth in
// at least 88, of 20 in at least 16: three standard deviations of the count below 95 %, and a
// little. Three constants fall short of it (docs/fits.md): the core's angle where all constants are
// free holds in 80 of 100, the flanks' in 88, and the ray of a kink in 13 of 20.
int least_inside(const Truth& truth, const std::string& name, int trials) {
  if (truth.model == "cantelaube" && name == "beta_hat_deg") return trials * 70 / 100;
  if (truth.model == "cantelaube" && name.starts_with("a_")) return trials * 80 / 100;
  if (name == "ray_deg") return trials * 50 / 100;
  return trials == 100 ? 88 : trials * 80 / 100;
}

void expect_coverage(const std::vector<FitModel>& models, const std::vector<Truth>& all,
                     FitData data, std::uint64_t seed, int trials = 100) {
  dem::Random random(seed);
  for (const Truth& truth : all) {
    const FitModel& model = find_fit_model(models, truth.model);
    const Eigen::VectorXd exact = predict(data, model, truth.parameters);
    std::vector<int> inside(model.parameters.size(), 0);
    for (int trial = 0; trial < trials; ++trial) {
      fill_as_grains(data, exact, 8, 0.1, random);
      FitOptions options;
      options.bootstrap = 0;
      options.profile = false;
      const Fit f = fit(data, weights_of(data), model, options);
      for (std::size_t k = 0; k < inside.size(); ++k) {
        inside[k] +=
            f.parameters[k].low < truth.parameters[k] && truth.parameters[k] < f.parameters[k].high;
      }
    }
    for (std::size_t k = 0; k < inside.size(); ++k) {
      const std::string& name = model.parameters[k].name;
      fmt::print("{} {}: {} of {}\n", truth.model, name, inside[k], trials);
      EXPECT_GE(inside[k], least_inside(truth, name, trials)) << truth.model << " " << name;
    }
  }
}

TEST(Fit, IntervalsCoverTheTruth) {
  expect_coverage(seen(heap_models({kSlope, kRhoG, kHeight}), places(15)), truths(), places(15),
                  11);
}

TEST(Fit, IntervalsCoverTheTruthOfTwoSlopes) {
  const FitData data = places(15, kLeft, kRight);
  expect_coverage(seen(heap_models(two_slopes()), data), two_sided_truths(), data, 21,
                  20);  // a trial takes more than a second
}

// The short form of `grainfield fit --coverage`: the truth is half-way between two models, so that
// none holds; intervals of few hold the constants of the rest, and hardly any verdict names another
// model than the rest do.
TEST(Fit, CoverageOfModelsThatDoNotHold) {
  FitData data = places(15);
  const auto known = seen(heap_models({kSlope, kRhoG, kHeight}), data);
  const FitModel& free = find_fit_model(known, "cantelaube");
  const Eigen::VectorXd truth =
      0.5 * predict(data, free, vector({0.34, 0.49, -0.2, 0.78, 1.23, 0.38, 35})) +
      0.5 * predict(data, find_fit_model(known, "hydrostatic"), Eigen::VectorXd(0));
  dem::Random random(4);
  fill_as_grains(data, truth, 96, 0.1, random);
  CoverageOptions options;
  options.sizes = {4, 8};
  options.draws = 40;
  options.bootstrap = 0;
  options.profile = false;
  std::vector<FitModel> models;
  for (const char* name :
       {"osl_yield", "osl", "cantelaube_continuous", "cantelaube_plus", "cantelaube"}) {
    models.push_back(find_fit_model(known, name));
  }
  const Coverage c = coverage_of(data, models, options);
  double pooled = 0;
  for (const ConstantCoverage& one : c.constants) {
    fmt::print("{} {} {}: {:.3f} of {}\n", one.model, one.parameter, one.size, one.by_jackknife,
               one.draws);
    // Free constants: a documented shortfall, on grains 82 to 90 % for a_xx, a_yy, a_xy.
    EXPECT_GE(one.by_jackknife, one.model == "cantelaube" ? 0.8 : 0.85)
        << one.model << " " << one.parameter << " " << one.size;
    pooled += one.by_jackknife / static_cast<double>(c.constants.size());
  }
  EXPECT_NEAR(pooled, 0.95, 0.04);
  for (const VerdictCoverage& v : c.verdicts) {
    EXPECT_LE(v.wrong, 3) << v.size;
    EXPECT_LE(v.false_alarms, 3) << v.size;
  }
}

// At least 95 of 100 ensembles name the model that made them; with an effect far below the noise
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
      const Weights c = weights_of(data);
      std::vector<Fit> fits;
      for (const FitModel& m : models) fits.push_back(fit(data, c, m, options));
      const Judgement s = select(data, c, models, fits);
      named += s.distinguishable == Answer::yes && s.best == name;
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
