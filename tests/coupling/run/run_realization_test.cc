// The file of a finished realization: any set of named snapshots, their order, all digits of the
// figures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/run/realization_file.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;

dem::Snapshot state(double time) {
  dem::Snapshot s;
  s.time = time;
  s.attributes["law"] = "overlap_area";
  dem::Grain g;
  g.radius = g.mass = g.inertia = g.volume = 1;
  g.outline = {{-1, -1}, {1, -1}, {0, 1}};
  s.grains = {g};
  return s;
}

TEST(RealizationFile, KeepsOrderFiguresAndAttributes) {
  const Folder folder;
  dem::RunResult result;
  // Against the alphabet: the file lists them by name.
  result.snapshots = {{"pile", state(1)}, {"gravity_20", state(2)}, {"gravity_0.98", state(3)}};
  result.figures = {{"dem.grains", 1}, {"dem.third", 1.0 / 3}, {"dem.none", std::nan("")}};
  const std::string file = folder / "r.h5";
  write_realization(file, result);
  EXPECT_FALSE(testing::fs::exists(file + ".part"));
  const Realization back = read_realization(file);
  ASSERT_EQ(back.snapshots.size(), 3U);
  EXPECT_EQ(back.snapshots[0].first, "pile");
  EXPECT_EQ(back.snapshots[1].first, "gravity_20");
  EXPECT_EQ(back.snapshots[2].first, "gravity_0.98");
  EXPECT_EQ(back["gravity_0.98"].time, 3);
  EXPECT_EQ(back.find("loaded"), nullptr);
  EXPECT_EQ(back.figures.size(), 3U);
  EXPECT_EQ(back.figures.at("dem.third"), 1.0 / 3);
  EXPECT_TRUE(std::isnan(back.figures.at("dem.none")));
  for (const auto& [name, snapshot] : back.snapshots) {
    EXPECT_EQ(snapshot.attributes, state(0).attributes) << name;
  }
  try {
    back["loaded"];
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("no snapshot \"loaded\" in the realization; there are: pile, "
                                    "gravity_20, gravity_0.98"));
  }
}

// The standard library's stod refuses subnormal figures.
TEST(RealizationFile, KeepsFiguresOfAnySize) {
  const Folder folder;
  dem::RunResult result;
  result.snapshots = {{"pile", state(1)}};
  result.figures = {{"tiny", 4.9406564584124654e-324}, {"huge", -1.7e308}, {"far", INFINITY}};
  write_realization(folder / "r.h5", result);
  EXPECT_EQ(read_realization(folder / "r.h5").figures, result.figures);
}

TEST(RealizationFile, NamesAFigureThatIsNoNumber) {
  const Folder folder;
  for (const auto& [key, value, wanted] :
       {std::tuple{"figure:dem.grains", "many", "a number"},
        std::tuple{"figure:dem.grains", "1e999", "a number"},
        std::tuple{"realization:order", "-1", "a whole number from 0"}}) {
    const std::string file = folder / "r.h5";
    dem::Snapshot s = state(1);
    s.attributes["realization:order"] = "0";
    s.attributes[key] = value;
    dem::write_snapshot(file, "/pile", s);
    try {
      read_realization(file);
      ADD_FAILURE() << value;
    } catch (const std::invalid_argument& e) {
      EXPECT_EQ(e.what(), file + ": " + key + " is \"" + value + "\"; it must be " + wanted);
    }
    testing::fs::remove(file);
  }
}

}  // namespace
}  // namespace grainfield::coupling
