// How many realizations more: what the number and its range promise.
#include <gtest/gtest.h>

#include "tests/coupling/foresight.h"

namespace grainfield::coupling {
namespace {

// The number is too large as often as too small, and its range holds the true one in 80 of 100
// ensembles, whatever the size of the difference.
TEST(Power, NumberIsUnbiasedAndItsRangeHolds) {
  constexpr int kTrials = 500;
  dem::Random random(5);
  for (const int n : {4, 8}) {
    for (const double size : {0.3, 1.2}) {
      const double truth = realizations_for_power(size, 1);
      int above = 0, inside = 0;
      for (int k = 0; k < kTrials; ++k) {
        const Power p = test::normal_difference(size, n, random).models.back().power;
        above += p.realizations > truth;
        inside += p.least <= truth && truth <= p.most;
      }
      // Four standard deviations of the counts.
      EXPECT_NEAR(above, 0.5 * kTrials, 45) << n << " " << size;
      EXPECT_NEAR(inside, 0.8 * kTrials, 36) << n << " " << size;
    }
  }
}

// Data far from two models that are near each other: the difference is found at once, but the
// models have to differ by more than its error.
TEST(Power, NumberCountsTheDistanceBetweenTheModels) {
  std::vector<Candidate> two(2);
  for (std::size_t k = 0; k < 2; ++k) {
    two[k].model.name = two[k].model.label = k == 0 ? "a" : "b";
    two[k].forecast = Eigen::MatrixXd::Constant(1, 1, k == 0 ? 0.2 : -0.2);
  }
  dem::Random random(7);
  const auto judged = [&](int realizations) {
    Evidence e = test::normal_evidence(5, realizations, random);
    return judge(e, two).models.back();
  };
  const int n = static_cast<int>(std::ceil(judged(20000).power.realizations));
  EXPECT_GT(n, 10);
  int found = 0;
  for (int k = 0; k < 400; ++k) found += judged(n).distinguishable == Answer::yes;
  // Four standard deviations of the count, and that n is a whole number.
  EXPECT_NEAR(found, 320, 32 + 8);
}

// Without a difference chance alone gives an upper limit in 10 of 100 ensembles, and a lower one in
// all but 10.
TEST(Power, ADifferenceWithinChanceHasNoUpperLimit) {
  dem::Random random(6);
  int open = 0, none = 0;
  for (int k = 0; k < 400; ++k) {
    const Power p = test::normal_difference(0, 8, random).models.back().power;
    open += std::isinf(p.most);
    none += std::isinf(p.least);
  }
  // Four standard deviations of the counts.
  EXPECT_NEAR(open, 360, 24);
  EXPECT_NEAR(none, 40, 24);
}

}  // namespace
}  // namespace grainfield::coupling
