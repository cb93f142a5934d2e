// How often the judge finds a known truth again, from contact forces on (docs/reliability.md):
//   build/release/tests/coupling_judge known_truth_long_test | grep '^|'
// Columns: truth; noise of the contact forces; ensembles; truth refused, nearest, best, supported;
// one model named, of these another one; truth said not to agree; constants inside their intervals.
#include <gtest/gtest.h>

#include "tests/coupling/known_truth.h"

namespace grainfield::coupling {
namespace {

constexpr int kDraws = 100, kRealizations = 8;
constexpr double kNoiseOfLayers = 0.5, kNoiseOfHeaps = 1;
// Alarms of a true model that the judge promises: 5 % in the comparison of two, 1 % in agreement;
// three standard deviations of the count.
constexpr int kMostRefused = 12, kMostDisagreeing = 5;

void report(const std::string& truth, double noise, const test::KnownTally& t) {
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} of {} |\n", truth, noise,
             t.truths, t.refused, t.nearest, t.best, t.supported, t.named, t.wrong, t.disagreeing,
             t.held, t.constants);
  fmt::print("known: {}, noise {}: {}\n", truth, noise, t.text());
  std::fflush(stdout);
}

std::uint64_t seed_of(std::size_t truth, int draw) {
  return 100'000 * (truth + 1) + 100 * static_cast<std::uint64_t>(draw) + 20001;
}

TEST(KnownTruth, LayersInAHundredEnsembles) {
  test::KnownLayers layers;
  layers.setup.disorder.noise = kNoiseOfLayers;
  for (std::size_t truth = 0; truth < layers.models.size(); ++truth) {
    test::KnownTally tally;
    for (int k = 0; k < kDraws; ++k) layers.strike(truth, kRealizations, seed_of(truth, k), tally);
    report(test::label_of(layers.models[truth]), kNoiseOfLayers, tally);
    EXPECT_LE(tally.refused, kMostRefused);
    EXPECT_LE(tally.wrong, kMostRefused);
    EXPECT_LE(tally.disagreeing, kMostDisagreeing);
  }
}

TEST(KnownTruth, HeapsInAHundredEnsembles) {
  test::KnownHeaps heaps;
  heaps.setup.disorder.noise = kNoiseOfHeaps;
  for (std::size_t k = 0; k < test::heap_truths().size(); ++k) {
    const auto truth = test::heap_truths()[k];
    test::KnownTally tally;
    for (int draw = 0; draw < kDraws; ++draw) {
      heaps.strike(truth, kRealizations, seed_of(10 + k, draw), tally);
    }
    report(truth.fit, kNoiseOfHeaps, tally);
    EXPECT_LE(tally.refused, kMostRefused);
    EXPECT_LE(tally.wrong, kMostRefused);
    EXPECT_LE(tally.disagreeing, kMostDisagreeing);
  }
}

}  // namespace
}  // namespace grainfield::coupling
