// Every few bytes of a file wrong; more of them: damaged_file_long_test.cc.
#include "tests/dem/flipped_snapshot.h"

namespace grainfield::dem {
namespace {

TEST(DamagedFileSlow, NoWrongByteGoesUnnoticed) { expect_flips_are_noticed(131, true, 1100); }

TEST(DamagedFileSlow, NoWrongByteOfAForeignFileEndsTheProgram) {
  expect_flips_are_noticed(53, false, 600);
}

}  // namespace
}  // namespace grainfield::dem
