// The text of the progress line.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include "continuum/model.h"
#include "continuum/progress.h"
#include "coupling/app/progress_line.h"

namespace grainfield::coupling {
namespace {

TEST(Progress, Durations) {
  EXPECT_EQ(duration_text(-1), "?");
  EXPECT_EQ(duration_text(0), "0:00");
  EXPECT_EQ(duration_text(59.6), "1:00");
  EXPECT_EQ(duration_text(245), "4:05");
  EXPECT_EQ(duration_text(3600 + 2 * 60 + 3), "1:02:03");
}

TEST(Progress, LineNamesEverything) {
  EnsembleProgress p;
  p.phase = "pour 80/6500";
  p.done = 1;
  p.total = 4;
  p.fraction = 0.1234;
  p.simulated_time = 1.2344;
  p.grains = 80;
  p.awake = 5;
  p.kinetic_energy = 1e-3;
  p.unbalanced_force_ratio = 0.02;
  p.seconds_left = 245;
  EXPECT_EQ(progress_text(p),
            " 12 %  1/4 done  pour 80/6500  t 1.234 s  80 grains, 5 awake  kinetic 1.0e-03 J  "
            "unbalanced 2.0e-02  4:05 left");
  // Nothing is said where none sleeps or nobody counts.
  p.awake = 80;
  EXPECT_EQ(progress_text(p).find("awake"), std::string::npos);
  p.awake = 0;
  EXPECT_EQ(progress_text(p).find("awake"), std::string::npos);
  p.seconds_left = -1;
  EXPECT_TRUE(progress_text(p).ends_with("? left"));
  // A solver without time has neither speeds nor a clock to tell of.
  p.phase = "gravity_5";
  p.simulated_time = p.kinetic_energy = p.unbalanced_force_ratio = 0;
  EXPECT_EQ(progress_text(p), " 12 %  1/4 done  gravity_5  80 grains  ? left");
  // Before the first realization has told anything, and after the last.
  p.phase = "";
  EXPECT_EQ(progress_text(p), " 12 %  1/4 done  starting");
  p.done = 4;
  p.fraction = 1;
  EXPECT_EQ(progress_text(p), "100 %  4/4 done");
}

// A task is spoken of when it has lasted for some seconds, and the next begins anew.
TEST(Progress, TasksThatLast) {
  ::testing::internal::CaptureStderr();
  ProgressLine line(false);
  {
    const TaskProgress tasks(line);
    continuum::tell_progress("quick", 0);
    continuum::tell_progress("quick", 1);
    continuum::tell_progress("slow", 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(3100));
    continuum::tell_progress("slow", 0.4);
    continuum::tell_progress("next", 0);
  }
  continuum::tell_progress("slow", 0.5);  // nobody listens
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "slow  40 %\n");
}

std::vector<double> told;

// A finite-element solve of steps tells how far it is, through the library that is loaded for it.
TEST(Progress, SolversOfStepsTellTheirShareOfTheLoad) {
  continuum::watch_progress([](const std::string& solver, double share) {
    EXPECT_EQ(solver, "fe_cone");
    told.push_back(share);
  });
  const auto model = continuum::make_model("fe_cone", {{"cells", "8"}, {"steps", "4"}});
  model->stress(Eigen::RowVector3d(0, 0, -0.5));
  continuum::watch_progress(nullptr);
  ASSERT_GE(told.size(), 2U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GT(told.front(), 0);
  EXPECT_EQ(told.back(), 1);
}

}  // namespace
}  // namespace grainfield::coupling
