// The estimate of the time left, of tasks whose parts take different times.
#include "coupling/run/time_left.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace grainfield::coupling {
namespace {

// A task that takes 130 s: half of it 10 s, a fifth (the load) 100 s, the rest 20 s.
constexpr double kWhole = 130;
double fraction_at(double seconds) {
  if (seconds < 10) return 0.05 * seconds;
  if (seconds < 110) return 0.5 + 0.002 * (seconds - 10);
  return std::min(1.0, 0.7 + 0.015 * (seconds - 110));
}

std::vector<std::size_t> all_of(std::size_t tasks) {
  std::vector<std::size_t> out(tasks);
  std::iota(out.begin(), out.end(), 0U);
  return out;
}

TEST(TimeLeft, LaterTasksTakeWhatTheFirstTook) {
  const auto mine = all_of(8);
  TimeLeft left(std::vector<std::size_t>(8, 0));
  EXPECT_LT(left.left(mine, 1), 0);
  double before = 8 * kWhole;
  for (int second = 0; second < 8 * 130; ++second) {
    left.tell(second / 130, second, fraction_at(second % 130));
    if (second % 130 == 129) left.tell(second / 130, second + 1, 1);
    const double now = left.left(mine, 1);
    if (second < 130) continue;
    EXPECT_LE(now, before + 1e-9) << second;
    EXPECT_NEAR(now, 8 * kWhole - second, 3) << second;
    before = now;
  }
  EXPECT_EQ(left.left(mine, 1), 0);
}

// While the first one carries its load, the load is all that is known of the time to come.
TEST(TimeLeft, FallsWhileTheFirstTaskIsSlow) {
  const auto mine = all_of(8);
  TimeLeft left(std::vector<std::size_t>(8, 0));
  double before = 0;
  for (int second = 0; second < 110; ++second) {
    left.tell(0, second, fraction_at(second));
    const double now = left.left(mine, 1);
    if (second > 25) {
      EXPECT_LT(now, before) << second;
    }
    before = now;
  }
  EXPECT_GT(before, 7 * kWhole);
}

TEST(TimeLeft, TasksAtOnceAndResumedOnes) {
  // Two at a time; the last one alone.
  TimeLeft left(std::vector<std::size_t>(3, 0));
  left.tell(0, 0, 0);
  left.tell(1, 0, 0);
  left.tell(0, 10, 1);
  left.tell(1, 10, 1);
  EXPECT_NEAR(left.left(all_of(3), 2), 10, 1e-9);
  // What a checkpoint had done took no time of this start.
  TimeLeft resumed(std::vector<std::size_t>(1, 0));
  resumed.tell(0, 0, 0.8);
  resumed.tell(0, 10, 0.9);
  EXPECT_NEAR(resumed.left({0}, 1), 10, 1e-9);
  // No progress, then very little: no hours.
  resumed.tell(0, 30, 0.85);
  EXPECT_NEAR(resumed.left({0}, 1), 10, 1e-9);
  resumed.tell(0, 30, 0.90001);
  EXPECT_LT(resumed.left({0}, 1), 1000);
}

// Members of a sweep may be a small layer and a large one.
TEST(TimeLeft, KindsHavePacesOfTheirOwn) {
  TimeLeft left({0, 0, 0, 1, 1});
  left.tell(0, 0, 0);
  left.tell(0, 10, 1);
  EXPECT_NEAR(left.left(all_of(5), 1), 40, 1e-9);
  left.tell(3, 10, 0);
  left.tell(3, 110, 1);
  EXPECT_NEAR(left.left(all_of(5), 1), 2 * 10 + 100, 1e-9);
}

}  // namespace
}  // namespace grainfield::coupling
