// At least 200 interruptions at random instants: kill -9, INT, TERM and HUP, to the process and to
// its group, once and twice, over fresh folders and over an earlier run's results; resumed, also
// from damaged checkpoints, every run ends with the bits of an uninterrupted one.
#include "tests/coupling/reliability_interrupts.h"

namespace grainfield::coupling::testing {
namespace {

TEST(Interrupts, TwoHundredAndNothingIsLost) {
  const Tally tally = interrupt_runs(220, 3, 0.5);
  tally.print("interrupts");
  EXPECT_GE(tally.signals, 200);
  EXPECT_GE(tally.killed, 25);
  EXPECT_GE(tally.stopped, 50);
  EXPECT_GE(tally.damaged, 5);
  for (const int signals : tally.at) EXPECT_GE(signals, 10);
}

}  // namespace
}  // namespace grainfield::coupling::testing
