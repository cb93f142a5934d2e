// What Liffman's soft piles and tents show, of the shipped cases with --quick: horizontal lines of
// force where rows touch, and the dip of a tent that such rows take away.
#include <gtest/gtest.h>

#include "coupling/result/tables.h"
#include "tests/coupling/program.h"
#include "tests/coupling/run_scene.h"
#include "tests/paths.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using testing::number;
using testing::Output;
using testing::program;

Summary quick(const Folder& folder, const std::string& name, const std::string& members) {
  const Output out = program("run " + std::string(GRAINFIELD_CASES) + "/" + name +
                             ".toml --quick --set 'sweep.values=[" + members +
                             "]' --set output.report=false -o " + (folder / name));
  EXPECT_EQ(out.code, 0) << out.err;
  return out.code == 0 ? read_summary(folder / (name + "/summary.json")) : Summary();
}

// Liffman figs 10 and 16: at 30 degrees most lines of minimum force are horizontal and hardly any
// of maximum force; in the equilateral pile none of either.
TEST(LatticeLines, AreHorizontalBelowSixtyDegreesOnly) {
  const Folder folder;
  const Summary s = quick(folder, "liffman-soft-piles", R"("slope_30","slope_60")");
  EXPECT_GT(number(s, "liffman.minimum_lines_level.slope_30"), 0.5);
  EXPECT_LT(number(s, "liffman.maximum_lines_level.slope_30"), 0.1);
  EXPECT_EQ(number(s, "liffman.minimum_lines_level.slope_60"), 0);
  EXPECT_EQ(number(s, "liffman.maximum_lines_level.slope_60"), 0);
  EXPECT_LT(number(s, "liffman.normal_max_error.slope_60"), 0.01);
}

// Liffman fig. 19: the line model has a dip, rows that touch have none; rows apart follow the
// lines.
TEST(LatticeLines, TentHasADipInTheLinesAndInRowsApart) {
  const Folder folder;
  const Summary s = quick(folder, "liffman-tent", R"("tent","apart")");
  EXPECT_GT(number(s, "liffman.normal_centre.tent"), 0.98);
  EXPECT_LT(number(s, "liffman.normal_centre.apart"), 0.95);
  EXPECT_LT(number(s, "liffman.line_normal_centre.tent"), 0.95);
}

}  // namespace
}  // namespace grainfield::coupling
