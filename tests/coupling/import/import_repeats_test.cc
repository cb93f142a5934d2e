// Steps that two files have, as continued runs leave them, and contacts that are there more than
// once.
#include <gmock/gmock.h>

#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Outcome;

class ImportRepeats : public testing::ImportOfFiles {
 protected:
  static void columns(ImportOptions& o) {
    o.columns = {"fnx,fny=fx,fy", "ftx,fty=0,0"};
    o.all_steps = true;
  }
};

TEST_F(ImportRepeats, EqualTablesOfTwoFilesCountOnce) {
  const std::string second = "3 0.0398 0.01 0.01 1\n",
                    rows = "1 0 0.01 0.01 1\n2 0.0199 0.01 0.01 1\n" + second,
                    turned = second + "1 0 0.01 0.01 1\n2 0.0199 0.01 0.01 1\n";
  const std::string pairs = "1 2 -1 0\n2 3 -2 0\n", swapped = "3 2 2 0\n1 2 -1 0\n";
  const std::string a = write("a", atoms(1000, "", rows) + atoms(2000, "", rows)),
                    b = write("b", atoms(2000, "", turned) + atoms(3000, "", rows)),
                    c = write("c", entries(1000, pairs) + entries(2000, pairs)),
                    d = write("d", entries(2000, swapped) + entries(3000, pairs));
  const Outcome outcome = import("lammps", {a, b, c, d}, columns);
  ASSERT_EQ(outcome.packings.size(), 3u) << outcome.refused;
  const ImportedSnapshot& both = outcome.packings[1];
  EXPECT_EQ(both.snapshot.grains.size(), 3u);
  ASSERT_EQ(both.snapshot.contacts.size(), 2u);
  EXPECT_EQ(both.snapshot.contacts[1].force.x(), -2);
  EXPECT_EQ(both.twice, 0);
  EXPECT_THAT(both.notes, Contains(HasSubstr("b: its 3 grains of this step are those of ")));
  EXPECT_THAT(both.notes, Contains(HasSubstr("d: its 2 contacts of this step are those of ")));
  EXPECT_THAT(outcome.packings[0].notes, ::testing::IsEmpty());
}

TEST_F(ImportRepeats, TablesThatDifferAreRefused) {
  const auto refused = [&](const std::string& rows, const std::string& pairs) {
    const std::string a = write("a", atoms(2000, "")), b = write("b", atoms(2000, "", rows)),
                      c = write("c", entries(2000)), d = write("d", entries(2000, pairs));
    return import("lammps", {a, b, c, d}, columns).refused;
  };
  const std::string same = "1 0 0.01 0.01 1\n2 0.0199 0.01 0.01 1\n", pair = "1 2 -1 0\n";
  EXPECT_EQ(refused(same, pair), "");
  EXPECT_THAT(refused("1 0 0.01 0.01 1\n2 0.0198 0.01 0.01 1\n", pair),
              HasSubstr("grain 2 is there already, at "));
  EXPECT_THAT(
      refused("1 0 0.01 0.01 1\n2 0.0198 0.01 0.01 1\n", pair),
      HasSubstr("found x = 0.0199 and 0.0198; allowed: one table of a step, or two that are "
                "equal; import the files of each run by itself"));
  EXPECT_THAT(refused(same + "3 0.5 0.5 0.01 1\n", pair),
              HasSubstr("b: 2 of its 3 grains are those of "));
  EXPECT_THAT(refused(same, "1 2 -2 0\n"), HasSubstr("found the forces 2 N and 1 N; allowed"));
}

// Dumps of several processors: parts of one table.
TEST_F(ImportRepeats, PartsAreJoined) {
  const std::string a = write("a", atoms(2000, "", "1 0 0.01 0.01 1\n")),
                    b = write("b", atoms(2000, "", "2 0.0199 0.01 0.01 1\n")),
                    c = write("c", entries(2000));
  const Outcome outcome = import("lammps", {a, b, c}, columns);
  EXPECT_EQ(only(outcome).snapshot.grains.size(), 2u);
}

// In a wrapped cell the second run carries back what has left it.
TEST_F(ImportRepeats, PlacesOfAnotherImageAreTheSame) {
  const std::string box = "pp ff ff\n0 0.06\n0 1\n0 1";
  const auto dump = [&](const char* first) {
    return atoms(2000, "", std::string(first) + " 0.01 0.01 1\n2 0.0199 0.01 0.01 1\n",
                 "id x y radius mass", box);
  };
  const std::string a = write("a", dump("1 0.0601")), b = write("b", dump("1 0.0001")),
                    c = write("c", entries(2000));
  EXPECT_EQ(only(import("lammps", {a, b, c}, columns)).snapshot.grains.size(), 2u);
}

// YADE's box of facets: a grain above the edge of two touches both, with the same force.
TEST_F(ImportRepeats, FacetsOfOneWallMayBearTheSame) {
  const std::string g = write("g", "# id x y z r mass\n6 0 0 0.0049 0.005 1\n");
  const auto floor = [](ImportOptions& o) {
    o.dim = 3;
    o.walls.push_back(parse_wall("floor:z=0:ids=0,1"));
  };
  const std::string rows = "0 6 0 0 2 0 0 1 0 0 0\n1 6 0 0 2 0 0 1 0 0 0\n",
                    names = "# id1 id2 fx fy fz nx ny nz px py pz\n";
  const Outcome two = import("yade", {g, write("c", names + rows)}, floor);
  ASSERT_EQ(only(two).snapshot.contacts.size(), 2u);
  EXPECT_EQ(only(two).snapshot.contacts[1].force.z(), 2);
  const std::string again = "0 6 0 0 2 0 0 1 0 0 0\n";
  EXPECT_THAT(import("yade", {g, write("d", names + rows + again)}, floor).refused,
              HasSubstr("the contact of grain 6 and wall floor is there already"));
}

// A file of contacts that stops before the other: its steps are not whole.
TEST_F(ImportRepeats, FilesThatHoldPartsOfEachStep) {
  const std::string rows = "1 0 0.01 0.01 1\n2 0.0199 0.01 0.01 1\n3 0.0398 0.01 0.01 1\n";
  const std::string g = write("g", atoms(0, "", rows) + atoms(1, "", rows) + atoms(2, "", rows)),
                    all = write("a", entries(0) + entries(1) + entries(2)),
                    some = write("s", entries(0, "2 3 -2 0\n") + entries(1, "2 3 -2 0\n"));
  const Outcome last = import("lammps", {g, all, some}, [](ImportOptions& o) {
    o.columns = {"fnx,fny=fx,fy", "ftx,fty=0,0"};
  });
  EXPECT_EQ(only(last).group, "/step_1");
  EXPECT_EQ(only(last).snapshot.contacts.size(), 2u);
  EXPECT_THAT(only(last).warnings, Contains(HasSubstr("have not all of the tables")));
  const Outcome every = import("lammps", {g, all, some}, columns);
  EXPECT_EQ(every.packings.size(), 2u);
}

// Two tables of contacts of one step in one file.
TEST_F(ImportRepeats, OtherColumnsAreAnotherTable) {
  const std::string rows = "1 0 0.01 0.01 1\n2 0.0199 0.01 0.01 1\n3 0.0398 0.01 0.01 1\n";
  const std::string c = write("c", entries(0) + entries(0, "2 3 -2 0\n", "id1 id2 forcex forcey"));
  const Outcome outcome =
      import("lammps", {write("g", atoms(0, "", rows)), c}, [](ImportOptions& o) {
        o.columns = {"fx,fy=fx,fy", "fx,fy=forcex,forcey"};
      });
  EXPECT_EQ(only(outcome).snapshot.contacts.size(), 2u);
}

// compute pair/local lists a pair once for each image within the cutoff, and a grain with its own.
TEST_F(ImportRepeats, ImagesBehindAGapAreNoContacts) {
  const std::string rows = "1 0.01 0.01 0.01 1\n2 0.0299 0.01 0.01 1\n";
  const std::string g =
      write("g", atoms(0, "", rows, "id x y radius mass", "pp ff ff\n0 0.041\n0 1\n0 1"));
  const std::string c = write("c", entries(0, "1 2 -1 0\n1 2 0 0\n1 1 0 0\n"));
  const Outcome outcome = import("lammps", {g, c}, columns);
  EXPECT_EQ(only(outcome).snapshot.contacts.size(), 1u);
  EXPECT_EQ(only(outcome).snapshot.contacts[0].force.x(), -1);
}

TEST_F(ImportRepeats, OneFileMayRepeatItsLineOfNames) {
  const std::string g = write("g.csv", grains_ + "id,x,y,radius,mass\n3,0.0398,0.01,0.01,1\n"),
                    c = write("c.csv", contacts_ + contacts_.substr(0, 10) + "2,3,-1,0\n");
  EXPECT_EQ(only(csv({g, c})).snapshot.contacts.size(), 2u);
}

TEST_F(ImportRepeats, IdsPrintedAlikeAreNamed) {
  const std::string g =
      write("g", atoms(0, "", "1.2345e+06 0 0.01 0.01 1\n1.2345e+06 1 1 0.01 1\n"));
  EXPECT_THAT(import("lammps", {g, write("c", entries(0))}, columns).refused,
              HasSubstr("ids are printed with 5 digits only"));
}

}  // namespace
}  // namespace grainfield::coupling
