// Columns that a reader could take for what they are not: units of some lengths, volumes of cells,
// molecules, moments of inertia.
#include <gmock/gmock.h>

#include "coupling/import/packing_warnings.h"
#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;

class ImportDoubts : public testing::ImportOfFiles {
 protected:
  Outcome grains(const std::string& text, const std::string& format = "csv") {
    return import(format, {write("g", text)}, [](ImportOptions& o) {
      o.without_contacts = true;
      o.density = 2500;
    });
  }
  double radius(const std::string& text, const std::string& format = "csv") {
    const auto& s = only(grains(text, format)).snapshot;
    return s.grains.empty() ? 0 : s.grains[0].radius;
  }
};

TEST_F(ImportDoubts, UnitsStandInAnyBrackets) {
  EXPECT_EQ(radius("id,x {mm},y {mm},radius {mm}\n1,0,0,5\n"), 0.005);
  EXPECT_EQ(radius("# id x(mm) y(mm) z(mm) r(mm)\n1 0 0 0 5\n", "yade"), 0.005);
  EXPECT_EQ(radius("# id x[mm] y[mm] z[mm] r[mm]\n1 0 0 0 5\n", "yade"), 0.005);
  EXPECT_EQ(radius("id,x (mm),y (mm),radius (\u00b5m)\n1,0,0,5000\n"), 0.005);
  EXPECT_EQ(radius("id,x (mm),y (mm),radius (\u03bcm)\n1,0,0,5000\n"), 0.005);
}

TEST_F(ImportDoubts, PowersAreWrittenInManyWays) {
  for (const char* unit :
       {"kg/m\u00b2", "kg/m**2", "kg m-2", "kg m^-2", "kg m\u207b\u00b2", "kg\u00b7m^-2"}) {
    const Outcome outcome =
        grains(std::string("id,x,y,radius,density (") + unit + ")\n1,0,0,0.005,1000\n");
    ASSERT_EQ(outcome.refused, "") << unit;
    EXPECT_NEAR(outcome.packings[0].snapshot.grains[0].mass, 1000 * M_PI * 25e-6, 1e-12) << unit;
  }
}

TEST_F(ImportDoubts, UnitsOfSomeLengthsAreRefused) {
  EXPECT_THAT(grains("id,x (mm),y,radius\n1,0,0,5\n").refused,
              HasSubstr("g:1: found the unit mm of x and none of radius, y, expected one of each "
                        "of them, such as \"radius (mm)\" or \"radius (m)\""));
  EXPECT_EQ(radius("id,x (m),y,radius\n1,0,0,5\n"), 5);
  EXPECT_EQ(radius("id,x (mm),y (mm),radius (m)\n1,0,0,5\n"), 5);
}

TEST_F(ImportDoubts, RowsOfUnitsStandAboveAndInComments) {
  for (const char* head : {"id,x,y,radius\n# -,mm,mm,mm\n", "-,mm,mm,mm\nid,x,y,radius\n",
                           "# id,x,y,radius\n# -,mm,mm,mm\n", "id,x,y,radius\n-,mm,mm,mm\n"})
    EXPECT_EQ(radius(std::string(head) + "1,0,0,5\n"), 0.005) << head;
}

TEST_F(ImportDoubts, RadiiInAnotherUnitThanThePlaces) {
  const auto doubts = [&](const char* radius) {
    const std::string g =
        write("g.csv", fmt::format("id,x,y,radius,mass\n1,0,0,{0},1\n2,0.0098,0,{0},1\n"
                                   "3,0.0196,0,{0},1\n",
                                   radius));
    return only(import("csv", {g}, [](ImportOptions& o) { o.without_contacts = true; })).warnings;
  };
  EXPECT_THAT(doubts("0.005"), Not(Contains(HasSubstr("overlap"))));
  EXPECT_THAT(
      doubts("0.0098"),
      Contains(HasSubstr("overlap by more than half the smaller radius: 2 (the first: 1 and "
                         "2); are the radii diameters, or in another unit than the places?")));
  EXPECT_THAT(doubts("5"), Contains(HasSubstr("in another unit")));
}

TEST_F(ImportDoubts, AVolumeThatIsNoGrainsIsRefused) {
  const std::string names = "id,x,y,z,radius,volume\n1,0,0,0,0.005,",
                    more = "\n2,0,0,1,0.005,5.236e-7\n";
  EXPECT_EQ(grains(names + "5.236e-7" + more).refused, "");
  EXPECT_THAT(
      grains(names + "8.1e-7" + more).refused,
      HasSubstr("grain 1: found volume 8.1e-07 and radius 0.005 m, which makes 5.23599e-07"));
}

TEST_F(ImportDoubts, AtomsOfOneMoleculeAreSaid) {
  const auto dump = [&](const std::string& molecules) {
    std::istringstream of(molecules);
    std::string rows, mol;
    for (int k = 1; of >> mol; ++k) rows += fmt::format("{} {} {} 0 0.01 1\n", k, mol, 0.03 * k);
    const std::string g = write("g", atoms(0, "", rows, "id mol x y radius mass"));
    return only(import("lammps", {g}, [](ImportOptions& o) { o.without_contacts = true; }))
        .warnings;
  };
  EXPECT_THAT(dump("1 1 2"), Contains(HasSubstr("grains of one rigid body")));
  EXPECT_THAT(dump("1 2 3"), Not(Contains(HasSubstr("rigid body"))));
  EXPECT_THAT(dump("0 0 0"), Not(Contains(HasSubstr("rigid body"))));
}

TEST_F(ImportDoubts, MomentsOfInertiaAreNoImageFlags) {
  EXPECT_EQ(radius("id,x,y,radius,Ix,Iy,Iz\n1,0,0,0.005,1e-7,1e-7,1e-7\n"), 0.005);
}

TEST_F(ImportDoubts, WhatOthersWriteForNoneAndForFlags) {
  const auto& s =
      only(grains("id,x,y,radius,fixed,vx\n1,0,0,0.005,True,NA\n2,1,0,0.005,False,<NA>\n"))
          .snapshot;
  EXPECT_TRUE(s.grains[0].fixed);
  EXPECT_FALSE(s.grains[1].fixed);
  EXPECT_EQ(s.grains[0].velocity.x(), 0);
  EXPECT_THAT(grains("id,x,y,radius,vx\n1,0,0,0.005,nan\n").refused,
              HasSubstr("column vx: found \"nan\", expected a finite number"));
  const std::string c = write("c.csv", "i,j,wall,fx,fy\n1,2,nan,-1,0\n");
  EXPECT_EQ(only(csv({write("g.csv", grains_), c})).snapshot.contacts.size(), 1u);
}

TEST_F(ImportDoubts, ContactPointsThatAreCentres) {
  const std::string g = write("g.csv", grains_);
  const auto doubts = [&](const char* point) {
    return only(csv({g, write("c.csv", std::string("i,j,fx,fy,px,py\n1,2,-1,0,") + point + "\n")}))
        .warnings;
  };
  EXPECT_THAT(doubts("0.01,0.01"), Not(Contains(HasSubstr("contact points"))));
  EXPECT_THAT(doubts("0,0.01"),
              Contains(HasSubstr("1 of 1 contact points lie farther than half a radius off the "
                                 "surfaces of their grains (the first: 1 and 2)")));
}

TEST_F(ImportDoubts, ShapesThatAreToldInPart) {
  const std::string axes = "id,x,y,z,axis_x,axis_y,axis_z,", row = "\n1,0,0,0,0.005,0.005,0.006,";
  const auto& square = only(grains(axes + "blockiness_1" + row + "8\n"));
  EXPECT_EQ(square.snapshot.grains[0].exponents, (std::array<double, 2>{1, 0.25}));
  const auto& round = only(grains(axes + "exponent_2" + row + "0.25\n"));
  EXPECT_EQ(round.snapshot.grains[0].exponents, (std::array<double, 2>{1, 0.25}));
  EXPECT_THAT(round.warnings, Contains(HasSubstr("no column tells how they are turned")));
  EXPECT_THAT(
      only(grains("id,x,y,z,axis_x,axis_y,axis_z,qw,qx,qy,qz" + row + "1,0,0,0\n")).warnings,
      ::testing::IsEmpty());
  const std::string dump =
      write("g", atoms(0, "", "1 0 0 0.01 1 0.01 0.01 0.02\n2 1 0 0.01 1 0.01 0.01 0.02\n",
                       "id x y radius mass c_shape[1] c_shape[2] c_shape[3]"));
  EXPECT_THAT(
      only(import("lammps", {dump}, [](ImportOptions& o) { o.without_contacts = true; })).warnings,
      Contains(HasSubstr("c_shape[1] c_shape[2] c_shape[3] tell of shapes")));
}

TEST_F(ImportDoubts, BracketsThatAreNoUnits) {
  const std::string g = "id,x (centroid),y (centroid),radius\n1,3,0,5\n";
  EXPECT_THAT(grains(g).refused, HasSubstr("where it is no unit: --column 'x=x (centroid)'"));
  const Outcome chosen = import("csv", {write("g", g)}, [](ImportOptions& o) {
    o.without_contacts = true;
    o.density = 1;
    o.columns = {"x=x (centroid)", "y=y (centroid)"};
  });
  EXPECT_EQ(only(chosen).snapshot.grains[0].position.x(), 3);
}

TEST_F(ImportDoubts, SignsInNamesMeanSomethingElse) {
  const std::string g = write("g.csv", grains_);
  for (const char* name : {"-fx", "|fx|", "fx*", "fx (N) x1000", "\u0394fx"})
    EXPECT_THAT(csv({g, write("c.csv", std::string("i,j,") + name + ",fy\n1,2,-1,0\n")}).refused,
                HasSubstr("no column \"fx\""))
        << name;
}

TEST_F(ImportDoubts, VariablesOfADumpAreNoVelocities) {
  const std::string g = write(
      "g", atoms(0, "", "1 0 0 0.01 1 5 6\n2 1 0 0.01 1 5 6\n", "id x y radius mass v_x v_y"));
  const Outcome outcome =
      import("lammps", {g}, [](ImportOptions& o) { o.without_contacts = true; });
  EXPECT_EQ(only(outcome).snapshot.grains[0].velocity.x(), 0);
}

TEST_F(ImportDoubts, AForceBesideItsTangentialPart) {
  const std::string g = write("g.csv", grains_),
                    c = write("c.csv", "i,j,fx,fy,ftx,fty\n1,2,-1,0,0,0.25\n");
  EXPECT_THAT(csv({g, c}).refused, HasSubstr("fx may be the whole force"));
  const auto force = [&](const char* column) {
    return only(import("csv", {g, c}, [&](ImportOptions& o) { o.columns = {column}; }))
        .snapshot.contacts[0]
        .force;
  };
  EXPECT_EQ(force("fx,fy=fx,fy"), dem::Vec3(-1, 0, 0));
  EXPECT_EQ(force("fnx,fny=fx,fy"), dem::Vec3(-1, 0.25, 0));
}

TEST_F(ImportDoubts, OutlinesStandAboutTheirPlaces) {
  const std::string names = "id,x,y,outline\n1,0.5,0.5,";
  EXPECT_EQ(grains(names + "-0.1 -0.1;0.1 -0.1;0 0.1\n").refused, "");
  EXPECT_THAT(grains(names + "0.4 0.4;0.6 0.4;0.5 0.6\n").refused,
              HasSubstr("its corners lie about (0.5, 0.466667), allowed: about (0, 0)"));
}

TEST_F(ImportDoubts, RoundingIsNoThirdDimension) {
  const std::string g =
      write("g.csv", "id,x,y,z,radius,mass\n1,0,0.01,0,0.01,1\n2,0.0199,0.01,1e-19,0.01,1\n");
  const std::string c = write("c.csv", "i,j,fx,fy,fz\n1,2,-1,0,1e-22\n");
  const dem::Snapshot& s = only(csv({g, c})).snapshot;
  EXPECT_EQ(s.dim, 2);
  EXPECT_EQ(s.gravity.y(), -9.81);
}

// LAMMPS' and LIGGGHTS' disks are spheres.
TEST_F(ImportDoubts, DensitiesOfDumpsAreThoseOfSpheres) {
  const std::string g =
      write("g", atoms(0, "", "1 0 0 0.01 2500\n2 1 0 0.01 2500\n", "id x y radius density"));
  const Outcome outcome =
      import("liggghts", {g}, [](ImportOptions& o) { o.without_contacts = true; });
  EXPECT_NEAR(only(outcome).snapshot.grains[0].mass, 2500 * 4.0 / 3 * M_PI * 1e-6, 1e-12);
}

TEST_F(ImportDoubts, WhatToDoStandsInTheRefusal) {
  EXPECT_THAT(grains("id,x,y,radius\nr1,1,0,0,0.005\n").refused, HasSubstr("row.names = FALSE"));
  EXPECT_THAT(grains("id,x,y,radius\n1,\"0,05\",0,0.005\n").refused,
              HasSubstr("found \"0,05\", expected a finite number: is the comma one of decimals"));
  // Ids called i do not make contacts of grains.
  EXPECT_THAT(
      csv({write("g.csv", "i,x,y,r,rho\n1,0,0,0.005,2500\n"), write("c.csv", contacts_)}).refused,
      HasSubstr("g.csv:1: no column \"id\"; found: i x y r rho"));
  // A facet with the id of a ball.
  const std::string c = write("c.csv", "i,j,fx,fy\n1,2,-1,0\n");
  EXPECT_THAT(import("csv", {write("g.csv", grains_), c},
                     [](ImportOptions& o) { o.walls.push_back(parse_wall("floor:y=0:ids=2")); })
                  .refused,
              HasSubstr("2 is a grain and one of the ids of wall floor, allowed: one meaning"));
}

}  // namespace
}  // namespace grainfield::coupling
