// What files begin with: titles, names in quotation marks between blanks, and the marks of other
// formats than the one that was named.
#include <gmock/gmock.h>

#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;

class ImportBeginnings : public testing::ImportOfFiles {};

TEST_F(ImportBeginnings, TitlesBeforeTheFirstStep) {
  for (const char* title :
       {"# run of the heap\n", "LAMMPS, heap 7\n", "heap 7\n\nmade by hand\n", "  \n"}) {
    const Outcome out = import(
        "lammps", {write("g.dump", title + atoms(0, "")), write("c.dump", title + entries(0))},
        [](ImportOptions& o) { o.columns = {"fx,fy=fx,fy"}; });
    EXPECT_EQ(only(out).snapshot.contacts.size(), 1u) << title;
  }
  // Between steps a line is none of a title.
  EXPECT_THAT(import("lammps", {write("h.dump", atoms(0, "") + "heap 7\n" + atoms(1, ""))}).refused,
              HasSubstr("h.dump:12: found \"heap 7\", expected \"ITEM: ...\""));
  EXPECT_THAT(
      import("lammps", {write("i.dump", "heap 7\nand 8\n")}).refused,
      HasSubstr("i.dump:1: found \"heap 7\", expected \"ITEM: ...\"; is this a dump file?"));
}

TEST_F(ImportBeginnings, SignsBetweenNamesAndTimesForSteps) {
  const Outcome out = import(
      "liggghts",
      {write("g.dump", atoms(0, "", "", "id, x, y, radius, mass,")), write("c.dump", entries(0))});
  EXPECT_EQ(only(out).snapshot.grains.size(), 2u);
  std::string time = atoms(7, "");
  time.replace(time.find("\n7\n"), 3, "\n0.5\n");
  EXPECT_THAT(import("lammps", {write("t.dump", time)}).refused,
              HasSubstr("t.dump:2: found \"0.5\", expected the number of the time step, a whole "
                        "number; a time in s stands behind a line \"ITEM: TIME\""));
}

// OVITO's tables.
TEST_F(ImportBeginnings, NamesInQuotationMarksBetweenBlanks) {
  const std::string table =
      "# \"Particle Identifier\" \"Position.X\" \"Position.Y\" \"Radius\" \"Mass\"\n"
      "1 0 0.01 0.01 1\n2 0.0199 0.01 0.01 1\n";
  for (const char* format : {"csv", "yade"}) {
    const std::string contacts =
        std::string(format) == "csv" ? contacts_ : "# id1 id2 fx fy\n1 2 1 0\n";
    const dem::Snapshot s =
        only(import(format, {write("g.txt", table), write("c.txt", contacts)})).snapshot;
    ASSERT_EQ(s.grains.size(), 2u) << format;
    EXPECT_EQ(s.grains[1].id, 2);
    EXPECT_EQ(s.grains[1].position.x(), 0.0199);
  }
}

TEST_F(ImportBeginnings, FilesOfAnotherFormatAreCalledByTheirName) {
  const struct {
    const char *format, *text, *words;
  } cases[] = {
      {"csv", "ITEM: TIMESTEP\n0\n", "a dump of LAMMPS or LIGGGHTS: --from lammps"},
      {"yade", "ITEM: TIMESTEP\n0\n", "a dump of LAMMPS or LIGGGHTS: --from lammps"},
      {"mercury", "ITEM: TIMESTEP\n0\n", "a dump of LAMMPS or LIGGGHTS: --from lammps"},
      {"vtk", "ITEM: TIMESTEP\n0\n", "a dump of LAMMPS or LIGGGHTS: --from lammps"},
      {"yade", "# vtk DataFile Version 3.0\nt\nASCII\n", "a file of VTK: --from vtk"},
      {"mercury", "# vtk DataFile Version 3.0\nt\nASCII\n", "a file of VTK: --from vtk"},
      {"lammps", "# vtk DataFile Version 3.0\nt\nASCII\n", "a file of VTK: --from vtk"},
      {"csv", "# vtk DataFile Version 3.0\nt\nASCII\n", "a file of VTK: --from vtk"},
      {"csv", "#format id_x_y_z_r\n1 0 0 0 1\n", "text of YADE: --from yade"},
      {"lammps", "#format id_x_y_z_r\n1 0 0 0 1\n", "text of YADE: --from yade"},
      {"lammps", "LAMMPS data file\n\n3 atoms\n", "a data file: read_data and a dump custom"},
      {"lammps", "---\ncreator: LAMMPS\n", "a dump of style yaml"},
      {"yade", "{\"x\": 1}\n", "JSON"},
  };
  for (const auto& one : cases)
    EXPECT_THAT(import(one.format, {write("f.txt", one.text)}).refused, HasSubstr(one.words))
        << one.format << ": " << one.text;
  // Its own beginning is no reason.
  EXPECT_THAT(import("yade", {write("y.txt", "#format id_x_y_z_r\n1 0 0\n")}).refused,
              Not(HasSubstr("this is")));
}

// textExt writes the word attrs for all of them.
TEST_F(ImportBeginnings, AttributesOfYadeHaveNumbers) {
  const Outcome out = import(
      "yade", {write("g.txt", "#format x_y_z_r_attrs\n0 0 0.01 0.01 2 7\n0 0 0.05 0.01 3 8\n")},
      [](ImportOptions& o) {
        o.without_contacts = true;
        o.dim = 3;
        o.columns = {"mass=attrs[1]", "id=attrs[2]"};
      });
  const dem::Snapshot s = only(out).snapshot;
  ASSERT_EQ(s.grains.size(), 2u);
  EXPECT_EQ(s.grains[1].id, 8);
  EXPECT_EQ(s.grains[1].mass, 3);
}

// The lines of Markdown and of text tables.
TEST_F(ImportBeginnings, RulesBelowNames) {
  const std::string contacts = write("c.csv", contacts_);
  for (const char* table :
       {"| id | x | y | radius | mass |\n|---|--:|:-:|---|---|\n| 1 | 0 | 0.01 | 0.01 | 1 |\n| 2 | "
        "0.0199 | 0.01 | 0.01 | 1 |\n",
        "  id    x      y     radius  mass\n ---- ------ ------ ------ ------\n 1 0 0.01 0.01 1\n "
        "2 0.0199 "
        "0.01 0.01 1\n",
        "id|x|y|radius|mass\n--+--+--+--+--\n1|0|0.01|0.01|1\n2|0.0199|0.01|0.01|1\n"}) {
    const dem::Snapshot s = only(csv({write("g.md", table), contacts})).snapshot;
    ASSERT_EQ(s.grains.size(), 2u) << table;
    EXPECT_EQ(s.grains[1].position.x(), 0.0199) << table;
  }
}

TEST_F(ImportBeginnings, RowsWithoutAnyNames) {
  for (const char* separator : {" ", "\t", ","}) {
    std::string rows;
    for (int k = 0; k < 4; ++k) rows += fmt::format("{1}.5{0}2.5{0}3{0}0.01\n", separator, k);
    EXPECT_THAT(csv({write("r.dat", rows)}).refused,
                HasSubstr("and no line of names above, expected one such as"))
        << separator;
  }
}

}  // namespace
}  // namespace grainfield::coupling
