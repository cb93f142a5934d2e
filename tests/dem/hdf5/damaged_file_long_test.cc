#include "tests/dem/flipped_snapshot.h"

namespace grainfield::dem {
namespace {

TEST(DamagedFileLong, NoWrongByteGoesUnnoticed) { expect_flips_are_noticed(61, true, 2500); }

TEST(DamagedFileLong, NoWrongByteOfAForeignFileEndsTheProgram) {
  expect_flips_are_noticed(23, false, 1400);
}

}  // namespace
}  // namespace grainfield::dem
