// Warnings of an import of many steps: each kind is said once, with the number of the others.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

TEST(ImportWarnings, AKindOfManyStepsIsSaidOnceWithItsCount) {
  const Folder folder;
  std::string grains, contacts;
  for (int step = 0; step < 30; ++step) {
    const std::string box = "ITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n";
    grains += fmt::format(
        "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n2\n{}ITEM: ATOMS id x y z radius mass\n"
        "1 0.1 0.5 0.1 0.1 1\n2 0.299 0.5 0.1 0.1 1\n",
        step, box);
    contacts += fmt::format(
        "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ENTRIES\n1\n{}ITEM: ENTRIES c_c[1] c_c[2] c_c[3] "
        "c_c[4] c_c[5]\n1 2 -{} 0 0\n",
        step, box, 1 + 0.01 * step);
  }
  const std::string command = fmt::format(
      "import --from lammps {} {} --column 'i,j,fx,fy,fz=c_c[1..5]' -o {}",
      folder.write("g.dump", grains), folder.write("c.dump", contacts), folder / "o.h5");
  const auto unbalanced = [](const Output& out) {
    int lines = 0;
    for (std::size_t at = 0; (at = out.err.find("unbalanced force ratio", at)) != std::string::npos;
         ++at)
      ++lines;
    return lines;
  };
  const Output all = program(command + " --step all");
  ASSERT_EQ(all.code, 0) << all.err;
  EXPECT_EQ(unbalanced(all), 2) << all.err;
  EXPECT_THAT(all.err, HasSubstr("warning: /step_0: unbalanced force ratio"));
  EXPECT_THAT(all.err,
              HasSubstr("29 more snapshots have this warning, the last is /step_29: unbalanced"));
  const Output two = program(command + " --step 3 --step 4");
  ASSERT_EQ(two.code, 0) << two.err;
  EXPECT_EQ(unbalanced(two), 2) << two.err;
  EXPECT_THAT(two.err, HasSubstr("warning: /step_4: unbalanced force ratio"));
}

}  // namespace
}  // namespace grainfield::coupling
