// Units, separators and signs of tables of text that people write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coupling/import/told_units.h"
#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;

class ImportSigns : public testing::ImportOfFiles {
 protected:
  Outcome grains(const std::string& text, const std::string& units = "m") {
    return import("csv", {write("g.csv", text)}, [&](ImportOptions& o) {
      o.without_contacts = true;
      o.units = units;
    });
  }
  // Radius of the first grain, m.
  double radius(const std::string& text) {
    const ImportedSnapshot one = only(grains(text));
    return one.snapshot.grains.empty() ? 0 : one.snapshot.grains.front().radius;
  }
  std::vector<std::string> warnings(const std::string& text, const std::string& units = "m") {
    const Outcome out = grains(text, units);
    EXPECT_EQ(out.refused, "");
    return out.packings.empty() ? std::vector<std::string>{} : out.packings.front().warnings;
  }
  const std::string rows_ = "1,0,0,5,2500\n2,10,0,5,2500\n";
  const std::string names_ = "id,x,y,radius,density\n";
};

TEST_F(ImportSigns, AUnitOfOneComponentOnly) {
  const std::string g = write("g.csv", grains_);
  EXPECT_THAT(csv({g, write("c.csv", "i,j,fx (kN),fy\n1,2,-1,0\n")}).refused,
              HasSubstr("found the unit kN of fx and none of fy"));
  EXPECT_EQ(csv({g, write("c.csv", "i,j,fx (N),fy\n1,2,-1,0\n")}).refused, "");
  EXPECT_THAT(grains("id,x,y,radius,mass,vx (mm/s),vy\n1,0,0,1,1,0,0\n").refused,
              HasSubstr("found the unit mm/s of vx and none of vy"));
}

TEST_F(ImportSigns, RowsOfUnitsWhereverTheyStand) {
  for (const std::string& head :
       {"# units: -,mm,mm,mm,kg/m2\n" + names_, names_ + "# Units = - mm mm mm kg/m2\n",
        names_ + "# written by hand\n-,mm,mm,mm,kg/m2\n",
        "-,mm,mm,mm,kg/m2\n# written by hand\n" + names_})
    EXPECT_EQ(radius(head + rows_), 0.005) << head;
}

TEST_F(ImportSigns, UnitsInWordsAreWarnedOf) {
  for (const std::string& head :
       {"# all lengths in mm\n" + names_, names_ + "# lengths: millimetres\n",
        "Packing 3 (cm)\n" + names_, "# units: -,mm\n" + names_})
    EXPECT_THAT(warnings(head + rows_),
                Contains(HasSubstr("no column has a unit: its numbers are")))
        << head;
  EXPECT_THAT(warnings("# beads of 5 mm\n" + names_ + rows_), Not(Contains(HasSubstr("unit"))));
  EXPECT_THAT(warnings("# all lengths in mm\n" + names_ + rows_, "mm"),
              Not(Contains(HasSubstr("no column has a unit"))));
  EXPECT_THAT(warnings("# all lengths in mm\nid,x (mm),y (mm),radius (mm),density\n" + rows_),
              ElementsAre());
  EXPECT_EQ(foreign_unit_in("lengths in \xc2\xb5m, please"), "\xc2\xb5m");
  EXPECT_EQ(foreign_unit_in("sieved at 5 mm"), "");
}

TEST_F(ImportSigns, SeparatedThousandsAreInDoubt) {
  const std::string head = "id;x (um);y (um);radius (um);density\n";
  EXPECT_THAT(warnings(head + "1;51,223;1,500;8,000;2500\n2;90,001;1,500;8,000;2500\n"),
              Contains(HasSubstr("every comma in its numbers has three digits behind it")));
  EXPECT_THAT(warnings(head + "1;51.223;1.500;8.000;2500\n2;90.001;1.500;8.000;2500\n"),
              Contains(HasSubstr("every point in its numbers has three digits behind it")));
  EXPECT_THAT(warnings(head + "1;51,223;1,5;8,000;2500\n2;90,001;1,500;8,000;2500\n"),
              Not(Contains(HasSubstr("three digits"))));
  EXPECT_THAT(warnings(head + "1;0,223;1,500;8,000;2500\n2;90,001;1,500;8,000;2500\n"),
              Not(Contains(HasSubstr("three digits"))));
  // One number of a table with points.
  EXPECT_THAT(grains("id;x;y;radius;density\n1;0.5;0;0.25;2,500\n").refused,
              HasSubstr("found \"2,500\", expected a finite number: is the comma one of decimals"));
}

TEST_F(ImportSigns, DecimalCommasInQuotationMarks) {
  EXPECT_EQ(
      radius("id,x,y,radius,density\n1,\"0,1\",0,\"0,005\",2500\n2,\"0,2\",0,\"0,005\",2500\n"),
      0.005);
  // The first one far down.
  std::string text = "id;x;y;radius;density\n";
  for (int k = 1; k <= 1100; ++k) text += fmt::format("{};{};0;1;2500\n", k, 3 * k);
  EXPECT_EQ(radius(text + "1101;5000,5;0;1;2500\n"), 1);
}

TEST_F(ImportSigns, HeadsAndCellsOfSpreadsheets) {
  EXPECT_EQ(radius("id,\"x\n(mm)\",\"y\n(mm)\",\"radius\n(mm)\",density\n" + rows_), 0.005);
  EXPECT_EQ(radius("id|x (mm)|y (mm)|radius (mm)|density\n1|0|0|5|2500\n2|10|0|5|2500\n"), 0.005);
  EXPECT_EQ(radius("id,x,y,radius,density\n=\"1\",0,0,5,2500\n=\"2\",10,0,5,2500\n"), 5);
  EXPECT_EQ(radius("id [#],x,y,radius,density\n1,0,0,5,2500\n2,10,0,5,2500\n"), 5);
  EXPECT_EQ(radius("id,x (\xb5m),y (\xb5m),radius (\xb5m),density\n" + rows_), 5e-6);
  std::string preamble;
  for (int k = 0; k < 70; ++k) preamble += fmt::format("line {} of a preamble\n", k);
  EXPECT_THAT(grains(preamble + names_ + rows_).refused,
              HasSubstr("no line of names among its first 60 lines"));
  EXPECT_THAT(csv({write("g.csv", grains_), write("c.csv", contacts_ + ",,5,5\n")}).refused,
              HasSubstr("a row of sums is no contact"));
}

TEST_F(ImportSigns, ASignOfNumberInTheLastValue) {
  const ImportedSnapshot one = only(grains(
      "id,x,y,radius,density,material\n1,0,0,5,2500,sand #0\n2,10,0,5,2500,sand #1\n3,20,0,5,2500,"
      "sand # the last\n"));
  ASSERT_EQ(one.snapshot.grains.size(), 3u);
  EXPECT_EQ(one.snapshot.grains[0].material, "sand #0");
  EXPECT_EQ(one.snapshot.grains[1].material, "sand #1");
  EXPECT_EQ(one.snapshot.grains[2].material, "sand");
  EXPECT_EQ(radius("id,x,y,density,radius\n1,0,0,2500,5 #first\n2,10,0,2500,5\n"), 5);
}

TEST_F(ImportSigns, ForcesAndMassesPerLengthInThePlane) {
  const std::string g =
      write("g.csv", "id,x,y,radius,mass (kg/m)\n1,0,0.01,0.01,1\n2,0.0199,0.01,0.01,1\n");
  EXPECT_EQ(csv({g, write("c.csv", "i,j,fx (N/m),fy (N/m)\n1,2,-1,0\n")}).refused, "");
  const std::string space =
      write("s.csv", "id,x,y,z,radius,mass\n1,0,0,0,0.01,1\n2,0,0,0.0199,0.01,1\n");
  EXPECT_THAT(csv({space, write("d.csv", "i,j,fx (N/m),fy (N/m),fz (N/m)\n1,2,0,0,-1\n")}).refused,
              HasSubstr("found \"fx (N/m)\" in a packing in 3D"));
  EXPECT_THAT(grains("id,x,y,z,radius,mass (kg/m)\n1,0,0,0,1,1\n2,0,0,1.9,1,1\n").refused,
              HasSubstr("in a packing in 3D"));
}

TEST_F(ImportSigns, PlanesThatLieElsewhere) {
  // Rounding along z, also of numbers with four bytes.
  const ImportedSnapshot flat =
      only(grains("id,x,y,z,radius,mass\n1,0,0,0.05,0.01,1\n2,0,0.0199,0.0500000007,0.01,1\n"));
  EXPECT_EQ(flat.snapshot.dim, 2);
  EXPECT_THAT(flat.notes, Contains(HasSubstr("less than a millionth of a radius")));
  const std::string xz = "id,x,y,z,radius,mass\n1,0,0,0,1,1\n2,0,0,1.9,1,1\n3,2,0,0,1,1\n";
  EXPECT_THAT(only(grains(xz)).notes, Contains(HasSubstr("--column y=z --column z=y")));
  const auto plane = import("csv", {write("g.csv", xz)}, [](ImportOptions& o) {
    o.without_contacts = true;
    o.dim = 2;
  });
  EXPECT_THAT(plane.refused, HasSubstr("every y is the same"));
}

TEST_F(ImportSigns, GapsBelowTheDigitsOfPlaces) {
  const auto read = [&](const std::string& x) {
    return only(import("csv", {write("g.csv", "id,x,y,radius,mass\n1,0.100001,0.01,0.0025,1\n2," +
                                                  x + ",0.01,0.0025,1\n"),
                               write("c.csv", contacts_)}));
  };
  const ImportedSnapshot digits = read("0.1050011");
  EXPECT_THAT(digits.warnings, Not(Contains(HasSubstr("across a gap"))));
  EXPECT_THAT(digits.notes, Contains(HasSubstr("that the 7 digits of the places leave open")));
  EXPECT_THAT(read("0.1051").warnings, Contains(HasSubstr("across a gap")));
  EXPECT_THAT(read("0.105001100000000011").warnings, Contains(HasSubstr("across a gap")));
}

TEST_F(ImportSigns, HintsThatLeadOn) {
  EXPECT_THAT(grains("id,x,y,radius,mass,time\n1,0,0,1,1,0\n1,0,0.1,1,1,1\n").refused,
              HasSubstr("the column time tells that the table has several times"));
  std::string tar(600, '\0');
  tar.replace(0, 6, "g.dump");
  tar.replace(257, 5, "ustar");
  EXPECT_THAT(csv({write("g.tar", tar)}).refused, HasSubstr("is an archive (tar) of files"));
  EXPECT_THAT(import("yade", {write("b.txt", "# id,x,y,z,r\n1,0,0,0,1\n")}).refused,
              HasSubstr("a table with commas is read by --from csv (with --flip-forces"));
  EXPECT_THAT(import("mercury", {write("m.fstat", "0 0 3 0 0 0 1e-6 0 1 0 1 0 0 0 1 0\n")}).refused,
              HasSubstr("a .fstat has three lines"));
}

TEST_F(ImportSigns, WallsThatCarryAlongAnotherAxis) {
  const std::string g =
      write("g.csv", "id,x,y,z,radius,mass\n1,0,0.01,0,0.01,1\n2,0.05,0.01,0.03,0.01,1\n");
  const std::string c = write("c.csv", "i,j,fx,fy,fz\n1,floor,0,9.81,0\n2,floor,0,9.81,0\n");
  const Outcome out =
      import("csv", {g, c}, [](ImportOptions& o) { o.walls = {parse_wall("floor:y=0")}; });
  const PackingCheck check = check_packing(only(out).snapshot);
  EXPECT_EQ(check.across, dem::Vec3(0, 19.62, 0));
  EXPECT_EQ(check.weight, 19.62);
}

}  // namespace
}  // namespace grainfield::coupling
