// Rolling resistance and local damping in cases: taken where they hold, else refused in one line.
#include <gmock/gmock.h>

#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

constexpr const char* kLayer = R"(study = "point-load"
[packing]
kind = "triangular"
columns = 12
rows = 5
sizes = "mono"
[ensemble]
realizations = 1
[rest]
unbalanced_force_ratio = 1e-4
kinetic_to_elastic_energy = 1e-6
[load]
force = 20
ramp_time = 0.02
)";
constexpr const char* kRolling =
    " --set material.rolling_friction=0.2 --set material.rolling_stiffness=1e6 --set "
    "material.rolling_damping=200";

Output check(const std::string& text, const std::string& sets) {
  const Folder folder;
  folder.write("case.toml", text);
  return program("check " + (folder / "case.toml") + sets);
}
void expect_refused(const std::string& text, const std::string& sets, const std::string& line) {
  const Output out = check(text, sets);
  EXPECT_EQ(out.code, 2) << out.err;
  EXPECT_THAT(out.err, HasSubstr(line));
  EXPECT_EQ(std::count(out.err.begin(), out.err.end(), '\n'), 1) << out.err;
}

TEST(RollingCase, WhatDoesNotHoldIsRefused) {
  const std::string pile = "study = \"pile\"\n[source]\ngrains = 50\n";
  EXPECT_EQ(check(kLayer, kRolling).code, 0) << check(kLayer, kRolling).err;
  expect_refused(kLayer, std::string(kRolling) + " --set load.method=newton",
                 "load.method: found \"newton\" with material.rolling_friction = 0.2, allowed: "
                 "\"damped\"");
  expect_refused(
      kLayer,
      " --set material.rolling_friction=0.2 --set material.rolling_stiffness=0 --set "
      "material.rolling_damping=0",
      "material.rolling_stiffness: found 0, allowed with material.rolling_friction = 0.2: "
      "above 0");
  // A dashpot alone holds nothing at rest.
  expect_refused(
      kLayer,
      " --set material.rolling_friction=0.2 --set material.rolling_stiffness=0 --set "
      "material.rolling_damping=0.01",
      "material.rolling_stiffness: found 0, allowed with material.rolling_friction = 0.2: "
      "above 0");
  EXPECT_EQ(check(pile, std::string(kRolling) + " --set shape.kind=disk").code, 0);
  expect_refused(pile, std::string(kRolling),
                 "material.rolling_friction: found above 0, allowed for polygons: 0");
  expect_refused(kLayer, " --set motion.local_damping=0.3 --set motion.integrator=gear",
                 "motion.local_damping: found 0.3 with motion.integrator \"gear\"");
  expect_refused(kLayer, " --set motion.local_damping=1",
                 "motion.local_damping: found 1, allowed: 0 to 0.99");
  expect_refused(kLayer, " --set material.tangential_memory=force",
                 "material.tangential_memory: found \"force\", allowed: only in three dimensions");
  expect_refused(kLayer, " --set material.twisting_friction=1",
                 "material.twisting_friction: found 1.0, allowed: only in three dimensions");
}

// They reach the grains, and a run ends in the same figures on one thread and two.
TEST(RollingCase, TheyReachTheGrains) {
  const Folder folder;
  folder.write("case.toml", kLayer);
  const auto summary = [&](const std::string& sets, const std::string& to) {
    const Output out =
        program("run " + (folder / "case.toml") + " -o " + (folder / to) + " " + sets);
    EXPECT_EQ(out.code, 0) << out.err;
    return testing::read_text(folder / (to + "/snapshots.h5"));
  };
  const std::string plain = summary("", "plain"), rolling = summary(kRolling, "rolling");
  EXPECT_NE(plain, rolling);
  EXPECT_NE(summary("--set motion.local_damping=0.3", "damped"), plain);
  EXPECT_EQ(summary(std::string(kRolling) + " --threads 2", "two"), rolling);
}

}  // namespace
}  // namespace grainfield::coupling
