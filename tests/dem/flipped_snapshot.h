// Every few bytes of a snapshot's file wrong, one after the other: all its blocks are met.
#pragma once
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/damaged_files.h"
#include "tests/dem/snapshot_scene.h"

namespace grainfield::dem {

/// Every `stride`-th byte wrong; `checked`: the file has checksums, else it is as HDF5 writes it by
/// default. There are at least `least` such copies.
inline void expect_flips_are_noticed(std::size_t stride, bool checked, int least) {
  const grainfield::testing::TestFolder folder;
  std::string file = folder / "s.h5";
  write_snapshot(file, "/a/loaded", full_snapshot(3));
  if (!checked) {
    const std::string plain = folder / "plain.h5";
    grainfield::testing::copy_plainly(file, plain);
    file = plain;
  }
  grainfield::testing::Damage found;
  grainfield::testing::flip_bytes(file, folder, stride, checked, bits_of_file, found);
  std::printf("%d copies, %d refused, %d by the look ahead\n", found.copies, found.refused,
              found.crashes);
  EXPECT_GT(found.copies, least);
}

}  // namespace grainfield::dem
