// Over synthetic ensembles: intervals hold the truth, and the choice between models names the one
// that made the data. More ensembles: fit_coverage_long_test.cc.
#include "coupling/fit/coverage.h"
#include "tests/coupling/fit_coverage.h"

namespace grainfield::coupling {
namespace {

// Of 30 ensembles 24 or fewer hold a constant with probability 0.003 where 95 % do, 0.80 where 75 %
// do.
TEST(Fit, IntervalsCoverTheTruth) {
  expect_coverage(seen(heap_models({kSlope, kRhoG, kHeight}), places(15)), truths(), places(15), 11,
                  30, 25);
}

// A trial takes more than a second. Of 8 ensembles 5 or fewer hold a constant with probability
// 0.006 where 95 % do, 0.45 where 70 % do.
TEST(Fit, IntervalsCoverTheTruthOfTwoSlopes) {
  const FitData data = places(15, kLeft, kRight);
  expect_coverage(seen(heap_models(two_slopes()), data), two_sided_truths(), data, 21, 8, 6);
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

// Of 40 ensembles 5 or more miss their model with probability 0.05 where 5 % do.
TEST(Fit, SelectionNamesTheModelThatMadeTheData) { expect_selection(40, 4); }

}  // namespace
}  // namespace grainfield::coupling
