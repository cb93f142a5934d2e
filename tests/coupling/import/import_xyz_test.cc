// Extended XYZ of OVITO and ASE.
#include <gmock/gmock.h>

#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Outcome;

class ImportXyz : public testing::ImportOfFiles {
 protected:
  static std::string state(const std::string& head, const std::string& rows) {
    return fmt::format("{}\n{}\n{}", std::count(rows.begin(), rows.end(), '\n'), head, rows);
  }
  static Outcome alone(const std::string& file, bool all = false) {
    return import("csv", {file}, [&](ImportOptions& o) {
      o.without_contacts = true;
      o.all_steps = all;
    });
  }
  // Two spheres that touch.
  static constexpr const char* kRows = "7 G 0.01 0.01 0.01 0.01 1\n9 G 0.0299 0.01 0.01 0.01 2\n";
  static constexpr const char* kHead =
      R"(Lattice="0.1 0 0 0.02 0.2 0 0 0 0.3" Origin="-0.01 0 0" )"
      R"(Properties=id:I:1:species:S:1:pos:R:3:radius:R:1:mass:R:1 pbc="T T F")";
};

TEST_F(ImportXyz, TellsItsColumnsItsCellAndItsIds) {
  const Outcome out = import(
      "csv", {write("a.xyz", state(kHead, kRows)), write("c.csv", "i,j,fx,fy,fz\n7,9,-1,0,0\n")},
      [](ImportOptions& o) { o.dim = 3; });
  const dem::Snapshot s = only(out).snapshot;
  ASSERT_EQ(s.grains.size(), 2u);
  EXPECT_EQ(s.grains[1].id, 9);
  EXPECT_EQ(s.grains[1].mass, 2);
  EXPECT_EQ(s.grains[1].position, dem::Vec3(0.0299, 0.01, 0.01));
  EXPECT_EQ(s.contacts.size(), 1u);
  EXPECT_EQ(s.cell.periodic, (std::array<bool, 3>{true, true, false}));
  EXPECT_EQ(s.cell.low.x(), -0.01);
  EXPECT_EQ(s.cell.edges(0, 1), 0.02);
  EXPECT_EQ(s.cell.edges(1, 1), 0.2);
}

// A table of contacts without a step is of one of the states, and nobody knows of which.
TEST_F(ImportXyz, ContactsWithoutAStepBesideSeveralStates) {
  const std::string contacts = write("p.csv", "i,j,fx,fy,fz\n7,9,-1,0,0\n");
  EXPECT_THAT(import("csv", {write("m.xyz", state(kHead, kRows) + state(kHead, kRows)), contacts},
                     [](ImportOptions& o) { o.dim = 3; })
                  .refused,
              HasSubstr("p.csv: tells no step, and there are the steps 0, 1"));
}

// Forces on grains make no table of contacts; a last row without its line end may be cut.
TEST_F(ImportXyz, ForcesBesidePlacesAndARowThatIsCut) {
  const std::string head = "Properties=species:S:1:pos:R:3:forces:R:3:id:I:1:mass:R:1";
  const auto sized = [&](const std::string& text) {
    return import("csv", {write("f.xyz", text)}, [](ImportOptions& o) {
      o.without_contacts = true;
      o.dim = 3;
      o.columns = {"radius=0.01"};
    });
  };
  const std::string whole = state(head, "G 0 0 0 1 2 3 1 1\nG 0 0 0.02 1 2 3 2 1\n");
  EXPECT_EQ(only(sized(whole)).snapshot.grains.size(), 2U);
  EXPECT_THAT(sized(whole.substr(0, whole.size() - 1)).refused,
              HasSubstr("truncated: 2 rows are announced, 1 are there (the last one ends without a "
                        "line end)"));
}

// OVITO and ASE write no ids of their own accord, velocities as velo, and T T T as nothing.
TEST_F(ImportXyz, WithoutIdsAndWithoutPeriods) {
  const dem::Snapshot s =
      only(alone(write(
               "b.xyz",
               state(R"(Lattice="1 0 0 0 1 0 0 0 1" Properties=species:S:1:pos:R:3:velo:)"
                     "R:3:force:R:3:Radius:R:1:Mass:R:1 Time=0.5",
                     "G 0.2 0.3 0.4 1 2 3 9 9 9 0.01 1\nG 0.5 0.3 0.8 4 5 6 9 9 9 0.02 2\n"))))
          .snapshot;
  ASSERT_EQ(s.grains.size(), 2u);
  EXPECT_EQ(s.dim, 3);
  EXPECT_EQ(s.time, 0.5);
  EXPECT_EQ(s.grains[1].velocity, dem::Vec3(4, 5, 6));
  EXPECT_EQ(s.grains[1].radius, 0.02);
  EXPECT_EQ(s.cell.periodic, (std::array<bool, 3>{true, true, true}));
}

TEST_F(ImportXyz, StatesOneAfterAnother) {
  const auto head = [](const char* more) {
    return fmt::format("Properties=id:I:1:pos:R:3:radius:R:1:mass:R:1 {}", more);
  };
  const std::string rows = "1 0 0 0 0.01 1\n2 0.5 0 0.1 0.01 1\n";
  const auto groups = [&](const std::string& text) {
    const Outcome out = alone(write("s.xyz", text), true);
    EXPECT_EQ(out.refused, "");
    std::vector<std::string> names;
    for (const auto& one : out.packings) names.push_back(one.group);
    return names;
  };
  EXPECT_EQ(groups(state(head("Timestep=100"), rows) + state(head("Timestep=250"), rows)),
            (std::vector<std::string>{"/step_100", "/step_250"}));
  EXPECT_EQ(groups(state(head(""), rows) + state(head(""), rows)),
            (std::vector<std::string>{"/step_0", "/step_1"}));
  const Outcome table = import(
      "csv", {write("t.xyz", state(head("Timestep=100"), rows) + state(head("Timestep=250"), rows)),
              write("c.csv", "i,j,fx,fy,fz\n1,2,-1,0,0\n")});
  EXPECT_THAT(table.refused, HasSubstr("c.csv tells no step and counts as step 0"));
}

TEST_F(ImportXyz, WhatIsNotWholeIsSaid) {
  EXPECT_THAT(alone(write("t.xyz", "3" + state(kHead, kRows).substr(1))).refused,
              HasSubstr("truncated: 3 rows are announced, 2 are there"));
  EXPECT_THAT(
      alone(write("p.xyz", "2\nAtoms. Timestep: 0\n1 0 0 0\n1 1 0 0\n")).refused,
      HasSubstr("p.xyz:2: found \"Atoms. Timestep: 0\" in the second line of a file of XYZ, "
                "expected names of its 4 columns"));
  EXPECT_THAT(alone(write("k.xyz", state("Properties=pos:R:3:radius", "0 0 0 1\n"))).refused,
              HasSubstr("expected NAME:TYPE:COUNT for each of them"));
  EXPECT_THAT(alone(write("l.xyz", state(R"(Lattice="1 0 0 0 1 0" Properties=pos:R:3:radius:R:1)",
                                         "0 0 0 1\n")))
                  .refused,
              HasSubstr("Lattice: found \"1 0 0 0 1 0\", expected 9 finite numbers"));
  // A table below the number of its rows is none of XYZ.
  EXPECT_EQ(alone(write("n.csv", "2\nid x y radius mass\n1 0 0 0.01 1\n2 1 0 0.01 1\n")).refused,
            "");
}

}  // namespace
}  // namespace grainfield::coupling
