// Over 100 synthetic ensembles: intervals hold the truth, and the choice between models names the
// one that made the data.
#include "tests/coupling/fit_coverage.h"

namespace grainfield::coupling {
namespace {

// The limit: 87 or fewer of 100 ensembles hold a constant with probability 0.0015 where 95 % do,
// 0.97 where 80 % do.
TEST(FitLong, IntervalsCoverTheTruth) {
  expect_coverage(seen(heap_models({kSlope, kRhoG, kHeight}), places(15)), truths(), places(15), 11,
                  100, 88);
}

TEST(FitLong, IntervalsCoverTheTruthOfTwoSlopes) {
  const FitData data = places(15, kLeft, kRight);
  expect_coverage(seen(heap_models(two_slopes()), data), two_sided_truths(), data, 21, 20, 16);
}

TEST(FitLong, SelectionNamesTheModelThatMadeTheData) { expect_selection(100, 5); }

}  // namespace
}  // namespace grainfield::coupling
