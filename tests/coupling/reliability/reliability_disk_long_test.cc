// Disks that run full anywhere: in checkpoints, realizations, fields, pictures and the summary.
#include "tests/coupling/reliability_disk.h"

namespace grainfield::coupling::testing {
namespace {

TEST(FullDiskLong, FilesMayNotGrow) {
  DiskTally tally;
  for (const TinyStudy& study : tiny_studies()) {
    limit_files(study.name,
                {0, 500, 2'000, 5'000, 12'000, 25'000, 50'000, 100'000, 200'000, 400'000, 800'000},
                true, tally);
  }
  limit_files("layer", {0, 500, 20'000, 60'000, 100'000, 300'000}, false, tally);
  tally.print("limited files");
  EXPECT_GE(tally.refused, 25);
}

TEST(FullDiskLong, ADiskRunsFull) {
  if (!SmallDisk::why_not().empty()) GTEST_SKIP() << SmallDisk::why_not();
  DiskTally tally;
  for (const TinyStudy& study : tiny_studies()) {
    for (const bool over_earlier : {false, true}) {
      fill_disk(study.name,
                {4'096, 16'384, 65'536, 131'072, 262'144, 524'288, 786'432, 1'048'576, 2'097'152,
                 4'194'304},
                over_earlier, tally);
    }
  }
  tally.print("full disk");
  EXPECT_GE(tally.refused, 25);
}

TEST(FullDiskLong, CommandsLeaveWhatWasThere) {
  DiskTally tally;
  limit_commands({0, 100, 1'000, 3'000, 10'000, 30'000, 100'000}, tally);
  tally.print("commands, limited files");
  EXPECT_GE(tally.refused, 25);
}

}  // namespace
}  // namespace grainfield::coupling::testing
