// Full disks: the short form of reliability_disk_long_test.cc.
#include "tests/coupling/reliability_disk.h"

namespace grainfield::coupling::testing {
namespace {

TEST(FullDisk, FilesMayNotGrow) {
  DiskTally tally;
  limit_files("layer", {2'000, 40'000, 200'000}, true, tally);
  tally.print("limited files");
  EXPECT_GE(tally.refused, 3);
}

TEST(FullDisk, ADiskRunsFull) {
  if (!SmallDisk::why_not().empty()) GTEST_SKIP() << SmallDisk::why_not();
  DiskTally tally;
  fill_disk("layer", {60'000, 700'000}, true, tally);
  tally.print("full disk");
  EXPECT_GE(tally.refused, 1);
}

TEST(FullDisk, CommandsLeaveWhatWasThere) {
  DiskTally tally;
  limit_commands({300, 20'000}, tally);
  tally.print("commands, limited files");
  EXPECT_GE(tally.refused, 10);
}

}  // namespace
}  // namespace grainfield::coupling::testing
