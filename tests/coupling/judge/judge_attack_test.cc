// The short form of judge_attack_long_test.cc.
#include "tests/coupling/judge_attack.h"

#include <gtest/gtest.h>

namespace grainfield::coupling {
namespace {

TEST(JudgeAttack, RandomTruthsAreSeldomRefused) {
  std::map<int, test::JudgeTally> tallies;
  test::JudgeAttack attack(1);
  for (int k = 0; k < 60; ++k) attack.strike(tallies);
  int truths = 0, refused = 0, named = 0, wrong = 0;
  for (const auto& [realizations, tally] : tallies) {
    truths += tally.truths;
    refused += tally.refused_truth;
    named += tally.named;
    wrong += tally.wrong;
  }
  // Rates of 5 % and three standard deviations of the counts.
  EXPECT_EQ(truths, 60);
  EXPECT_LE(refused, 8);
  EXPECT_LE(wrong, 8);
  EXPECT_GT(named, 10);
}

TEST(JudgeAttack, OneFieldIsSeldomRefusedItsTruth) {
  test::JudgeTally tally;
  test::JudgeAttack attack(2);
  for (int k = 0; k < 40; ++k) attack.strike_one_field(tally);
  EXPECT_EQ(tally.truths, 40);
  EXPECT_LE(tally.refused_truth, 2);
  EXPECT_LE(tally.wrong, 2);
  EXPECT_GT(tally.named, 0);
}

}  // namespace
}  // namespace grainfield::coupling
