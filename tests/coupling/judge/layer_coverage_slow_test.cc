// Synthetic truth: ensembles of layers per model; coverage of the intervals, and the verdict. More
// of them: layer_coverage_long_test.cc.
#include "tests/coupling/layer_coverage.h"

namespace grainfield::coupling {
namespace {

// Of 20 ensembles 15 or fewer hold a constant with probability 0.003 where 95 % do, 0.76 where 70 %
// do.
TEST(LayerFit, IntervalsCoverTheTruth) { expect_coverage_of_layers(20, 16); }

// An elliptic and a hyperbolic model; a trial takes more than a second. Of 6 trials 4 or fewer name
// it with probability 0.03 where 95 % do, 0.58 where 70 % do.
TEST(LayerFit, VerdictNamesTheModelThatMadeTheResponse) {
  expect_named(1, 6, 5);
  expect_named(6, 6, 5);
}

// A trial in such noise takes ten seconds and more: the searches wander.
TEST(LayerFit, VerdictIsNotDistinguishableBelowTheNoise) { expect_undecided(1, 1, 1); }

}  // namespace
}  // namespace grainfield::coupling
