// Numbers, names and columns as other programs spell them: read where they mean one thing only,
// else refused with what to do next.
#include <gmock/gmock.h>

#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;

class ImportSpellings : public testing::ImportOfFiles {
 protected:
  Outcome grains(const std::string& text) {
    return import("csv", {write("g", text)}, [](ImportOptions& o) {
      o.without_contacts = true;
      o.density = 2500;
    });
  }
  Outcome contacts(const std::string& text) {
    return csv({write("g.csv", grains_), write("c.csv", text)});
  }
  dem::Grain grain(const std::string& text) {
    const dem::Snapshot s = only(grains(text)).snapshot;
    return s.grains.empty() ? dem::Grain{} : s.grains.front();
  }
  Outcome dump(const std::string& units, const std::string& chosen) {
    return import("lammps", {write("g.dump", "ITEM: UNITS\n" + units + "\n" + atoms(1, ""))},
                  [&](ImportOptions& o) {
                    o.without_contacts = true;
                    o.units = chosen;
                  });
  }
};

TEST_F(ImportSpellings, SignsThatMeanAPlainOne) {
  const std::string head = "id,x,y,radius\n";
  EXPECT_EQ(grain(head + "1,\u22120.5,0,0.005\n").position.x(), -0.5);
  EXPECT_EQ(grain("id,\u00a0x,\u00a0y,\u00a0radius\n1,\u00a00.5,\u00a00,\u00a00.005\n").radius,
            0.005);
  EXPECT_EQ(grain(head + "1,-5.0D-01,0d0,0.5D-2\n").position.x(), -0.5);
  EXPECT_EQ(grain(head + "1,0.5,0,0.005\n\x1a").radius, 0.005);
  // A file with a byte order mark behind another.
  EXPECT_EQ(only(grains(head + "1,0,0,0.005\n\xEF\xBB\xBF" + head + "2,1,0,0.005\n"))
                .snapshot.grains.size(),
            2u);
}

TEST_F(ImportSpellings, ASignAcrossTwoBlocksOfAFile) {
  constexpr std::size_t kBlock = 65536;
  const std::string head = "id,x,y,radius\n";
  for (std::size_t cut = 1; cut < 3; ++cut) {
    std::string text = head;
    const std::string last = "7,\u22120.5,0,0.005\n";
    while (text.size() + 2 + cut < kBlock) text += '\n';
    EXPECT_EQ(grain(text + last).position.x(), -0.5) << cut;
  }
}

TEST_F(ImportSpellings, NamesBehindOtherSignsOfComments) {
  EXPECT_EQ(grain("% id,x,y,radius\n1,0.5,0,0.005\n").position.x(), 0.5);
  EXPECT_EQ(grain("// id x y radius\n1 0.5 0 0.005\n").position.x(), 0.5);
  EXPECT_EQ(grain("#,x,y,radius\n31,0.5,0,0.005\n").id, 31);
}

TEST_F(ImportSpellings, UnitsUnderNamesOfNumbers) {
  for (const char* none : {"no.", "integer", "#", "-"})
    EXPECT_EQ(grain(std::string("id,x,y,radius\n") + none + ",mm,mm,mm\n1,0,0,5\n").radius, 0.005)
        << none;
}

TEST_F(ImportSpellings, ThousandsBesideDecimals) {
  EXPECT_EQ(grain("id;x (um);y (um);radius (um)\n1.001;50.000,0;0,5;5.000\n").radius, 0.005);
  EXPECT_EQ(grain("id;x (um);y (um);radius (um)\n1.001;50.000,0;0,5;5.000\n").id, 1001);
  EXPECT_EQ(grain("id,x (um),y (um),radius (um)\n1,50'000.0,0.5,5'000\n").radius, 0.005);
  EXPECT_EQ(grain("id,x (um),y (um),radius (um)\n1,\"50,000.0\",0.5,\"5,000\"\n").radius, 0.005);
  EXPECT_THAT(grains("id;x;y;radius\n1;50.000,0;0,5;0.005\n").refused,
              HasSubstr("expected a comma in decimals"));
}

TEST_F(ImportSpellings, IdsThatAreNone) {
  EXPECT_THAT(grains("id,x,y,radius\nP11,0,0,1\n").refused, HasSubstr("leave the letters out"));
  EXPECT_THAT(grains("id,x,y,radius\n1,0,0,1\nTotal,1,,\n").refused,
              HasSubstr("leave out rows of sums"));
}

TEST_F(ImportSpellings, NormalForcesAlone) {
  const ImportedSnapshot one = only(contacts("i,j,fn\n1,2,3\n"));
  ASSERT_EQ(one.snapshot.contacts.size(), 1u);
  EXPECT_NEAR(one.snapshot.contacts[0].force.x(), -3, 1e-14);
  EXPECT_THAT(one.warnings, Contains(HasSubstr("read without friction")));
  EXPECT_THAT(contacts("i,j,force\n1,2,3\n").refused, HasSubstr("no column \"fn\""));
  EXPECT_THAT(contacts("i,j,fn,other\n1,2,3,1\n").refused, HasSubstr("--column ft=0"));
}

TEST_F(ImportSpellings, ASizeBesideAShearVector) {
  const ImportedSnapshot one = only(contacts("i,j,fn,fsx,fsy\n2,1,3,0,0.5\n"));
  ASSERT_EQ(one.snapshot.contacts.size(), 1u);
  EXPECT_NEAR(one.snapshot.contacts[0].force.x(), -3, 1e-14);
  EXPECT_NEAR(one.snapshot.contacts[0].force.y(), -0.5, 1e-14);
}

TEST_F(ImportSpellings, MassesOfSomeAndDensitiesOfOthers) {
  const dem::Snapshot s =
      only(grains("id,x,y,radius,mass,density\n1,0,0,0.005,2,\n2,1,0,0.005,,1000\n3,2,0,0.005,,\n"))
          .snapshot;
  ASSERT_EQ(s.grains.size(), 3u);
  EXPECT_EQ(s.grains[0].mass, 2);
  EXPECT_NEAR(s.grains[1].mass, 1000 * M_PI * 25e-6, 1e-12);
  EXPECT_NEAR(s.grains[2].mass, 2500 * M_PI * 25e-6, 1e-12);
}

TEST_F(ImportSpellings, ANumberThatIsCutOff) {
  const std::string rows = "id,x,y,radius\n1,0,0,0.0051\n2,1,0,0.0051\n3,2,0,0.0051\n4,3,0,0.";
  EXPECT_THAT(only(grains(rows + "005")).warnings, Contains(HasSubstr("is it cut off?")));
  for (const char* whole : {"0051", "005\n"})
    EXPECT_THAT(only(grains(rows + whole)).warnings, Not(Contains(HasSubstr("cut off")))) << whole;
}

TEST_F(ImportSpellings, UnitsThatAreNoneOfSi) {
  EXPECT_THAT(dump("lj", "").refused, HasSubstr("--units m reads the numbers as they are"));
  EXPECT_EQ(only(dump("lj", "m")).snapshot.grains.front().radius, 0.01);
}

TEST_F(ImportSpellings, TheFirstLineTellsTheFormat) {
  EXPECT_THAT(grains(atoms(1, "")).refused, HasSubstr("--from lammps"));
  EXPECT_THAT(grains("# vtk DataFile Version 3.0\nx\n").refused, HasSubstr("--from vtk"));
  EXPECT_THAT(grains("#format id_x_y_z_r\n1 0 0 0 1\n").refused, HasSubstr("--from yade"));
  EXPECT_THAT(grains("[\n {\"id\": 1}\n]\n").refused, HasSubstr("JSON"));
}

TEST_F(ImportSpellings, TimesOfVtk) {
  const auto text = [](const char* time) {
    return fmt::format(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nFIELD FieldData 1\nTimeValue 1 1 "
        "double\n{}\nPOINTS 2 double\n0 0 0\n0.0199 0 0\n",
        time);
  };
  const std::string of_grains =
      "POINT_DATA 2\nFIELD FieldData 2\nid 1 2 int\n1 2\nradius 1 2 "
      "double\n0.01 0.01\n";
  const std::string of_contacts =
      "LINES 1 3\n2 0 1\nPOINT_DATA 2\nFIELD FieldData 1\nid 1 2 int\n"
      "1 2\nCELL_DATA 1\nVECTORS force double\n-1 0 0\n";
  const auto import_at = [&](const char* time) {
    return only(import(
        "vtk", {write("g.vtk", text("0.5") + of_grains), write("c.vtk", text(time) + of_contacts)},
        [](ImportOptions& o) { o.density = 2500; }));
  };
  EXPECT_EQ(import_at("0.5").snapshot.time, 0.5);
  EXPECT_THAT(import_at("0.7").warnings, Contains(HasSubstr("are they of one state?")));
}

TEST_F(ImportSpellings, NamesOfProgramsWithWindows) {
  EXPECT_EQ(grain("Particle ID,Particle X-Coordinate [m],Particle Y-Coordinate [m],radius\n"
                  "7,0.5,0,0.005\n")
                .position.x(),
            0.5);
  EXPECT_EQ(grain("Particle Identifier,Position.X,Position.Y,Radius\n7,0.5,0,0.005\n").id, 7);
  const ImportedSnapshot pfc =
      only(contacts("end1,end2,force_global_x,force_global_y\n1,2,-1,0\n"));
  EXPECT_EQ(pfc.snapshot.contacts.front().force.x(), -1);
}

}  // namespace
}  // namespace grainfield::coupling
