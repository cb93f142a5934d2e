// Alarm rates of the judge over a thousand random truths (docs/reliability.md):
//   build/release/tests/coupling_judge judge_attack_long_test | grep judge:
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/coupling/judge_attack.h"

namespace grainfield::coupling {
namespace {

TEST(JudgeAttack, AThousandRandomTruths) {
  const char* seed = std::getenv("GRAINFIELD_SEED");
  std::map<int, test::JudgeTally> tallies;
  test::JudgeAttack attack(seed != nullptr ? std::strtoull(seed, nullptr, 10) : 20001);
  for (int k = 0; k < 1000; ++k) attack.strike(tallies);
  for (const auto& [realizations, tally] : tallies) {
    fmt::print("judge: {} realizations, {}\n", realizations, tally.text());
    EXPECT_LE(tally.refused_truth, 0.05 * tally.truths + 3 * std::sqrt(0.05 * tally.truths));
    EXPECT_LE(tally.wrong, 0.05 * tally.truths + 3 * std::sqrt(0.05 * tally.truths));
  }
}

TEST(JudgeAttack, FiveHundredFieldsWithErrors) {
  test::JudgeTally tally;
  test::JudgeAttack attack(20002);
  for (int k = 0; k < 500; ++k) attack.strike_one_field(tally);
  fmt::print("judge: one field, {}\n", tally.text());
  EXPECT_LE(tally.refused_truth, 0.01 * tally.truths);
  EXPECT_LE(tally.wrong, 0.01 * tally.truths);
}

}  // namespace
}  // namespace grainfield::coupling
