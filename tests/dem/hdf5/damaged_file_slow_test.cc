// Every few bytes of a file wrong, one after the other: all its blocks are met.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/damaged_files.h"
#include "tests/dem/snapshot_scene.h"

namespace grainfield::dem {
namespace {

TEST(DamagedFileSlow, NoWrongByteGoesUnnoticed) {
  const grainfield::testing::TestFolder folder;
  const std::string file = folder / "s.h5";
  write_snapshot(file, "/a/loaded", full_snapshot(3));
  grainfield::testing::Damage found;
  grainfield::testing::flip_bytes(file, folder, 61, true, bits_of_file, found);
  std::printf("%d copies, %d refused, %d by the look ahead\n", found.copies, found.refused,
              found.crashes);
  EXPECT_GT(found.copies, 2500);
}

TEST(DamagedFileSlow, NoWrongByteOfAForeignFileEndsTheProgram) {
  const grainfield::testing::TestFolder folder;
  write_snapshot(folder / "s.h5", "/a/loaded", full_snapshot(3));
  const std::string plain = folder / "plain.h5";
  grainfield::testing::copy_plainly(folder / "s.h5", plain);
  grainfield::testing::Damage found;
  grainfield::testing::flip_bytes(plain, folder, 23, false, bits_of_file, found);
  std::printf("%d copies, %d refused, %d by the look ahead\n", found.copies, found.refused,
              found.crashes);
  EXPECT_GT(found.copies, 1400);
}

}  // namespace
}  // namespace grainfield::dem
