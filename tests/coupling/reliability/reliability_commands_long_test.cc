// Every command that writes, struck 24 times at random instants and while it writes.
#include "tests/coupling/reliability_commands.h"

namespace grainfield::coupling::testing {
namespace {

TEST(CommandsLong, OutputsAreOldOrNew) {
  const CommandTally tally = interrupt_commands(24);
  tally.print();
  EXPECT_GE(tally.signals, 120);
  EXPECT_GE(tally.old, 40);
}

}  // namespace
}  // namespace grainfield::coupling::testing
