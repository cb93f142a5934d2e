// What becomes of each column: taken, told to be left, or asked about; never lost in silence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;

class ImportColumns : public testing::ImportOfFiles {
 protected:
  Outcome grains(const std::string& text) {
    return import("csv", {write("g.csv", text)},
                  [](ImportOptions& o) { o.without_contacts = true; });
  }
  Outcome contacts(const std::string& text) {
    return csv({write("g.csv", grains_), write("c.csv", text)});
  }
  Outcome vtk(const std::string& arrays, const std::string& title = "made here") {
    const std::string text = "# vtk DataFile Version 3.0\n" + title +
                             "\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n0 0 0\n0 0 0.0199\n"
                             "POINT_DATA 2\nSCALARS id int 1\nLOOKUP_TABLE default\n1 2\n" +
                             arrays;
    return import("vtk", {write("g.vtk", text)}, [](ImportOptions& o) {
      o.without_contacts = true;
      o.density = 2500;
    });
  }
  static std::vector<std::string> warnings(const Outcome& outcome) {
    EXPECT_EQ(outcome.refused, "");
    return outcome.packings.empty() ? std::vector<std::string>{} : outcome.packings[0].warnings;
  }
  static std::vector<std::string> notes(const Outcome& outcome) {
    EXPECT_EQ(outcome.refused, "");
    return outcome.packings.empty() ? std::vector<std::string>{} : outcome.packings[0].notes;
  }
  static constexpr const char* kRadius =
      "SCALARS radius double 1\nLOOKUP_TABLE default\n0.01 0.01\n";
};

TEST_F(ImportColumns, AllThatAreNotTakenAreNamedOnce) {
  const Outcome some =
      grains("id,type,x,y,radius,mass,s[1],s[2],s[3]\n1,1,0,0,1,1,0,0,0\n2,1,0,1.9,1,1,0,0,0\n");
  EXPECT_THAT(notes(some), Contains(HasSubstr("columns that are not taken: type s[1..3]")));
  EXPECT_EQ(warnings(some), std::vector<std::string>{});
  EXPECT_THAT(notes(grains("id,x,y,radius,mass\n1,0,0,1,1\n")), ElementsAre());
}

TEST_F(ImportColumns, WhatNamesTellOfGrains) {
  const auto warned = [&](const std::string& names) {
    const auto count = std::count(names.begin(), names.end(), ',') + 1;
    std::string zeros;
    for (long k = 0; k < count; ++k) zeros += ",0";
    return warnings(grains("id,x,y,radius,mass," + names + "\n1,0,0,1,1" + zeros + "\n2,0,1.9,1,1" +
                           zeros + "\n"));
  };
  EXPECT_THAT(warned("vel_a,vel_b"), ElementsAre(HasSubstr("tell of velocities: vel_a vel_b")));
  EXPECT_THAT(warned("Omega"), ElementsAre(HasSubstr("tell of angular velocities: Omega")));
  EXPECT_THAT(warned("q1,q2,q3,q4"), ElementsAre(HasSubstr("tell of orientations: q1 q2 q3 q4")));
  EXPECT_THAT(warned("a,b,c"), ElementsAre(HasSubstr("tell of shapes: a b c")));
  EXPECT_THAT(warned("unit"), ElementsAre(HasSubstr("tell of units: unit")));
  // What is told by another column is not missed.
  EXPECT_THAT(warned("vx,vy,v"), ElementsAre());
  EXPECT_THAT(warned("fx,fy,fz,torque"), ElementsAre());
}

TEST_F(ImportColumns, OfDumpsTheNameBehindThePrefix) {
  const auto read = [&](const std::string& names, const std::string& values) {
    return warnings(import(
        "lammps",
        {write("g.dump",
               atoms(0, "", "1 0 0.01 0.01 1" + values + "\n2 0.0199 0.01 0.01 1" + values + "\n",
                     "id x y radius mass" + names))},
        [](ImportOptions& o) { o.without_contacts = true; }));
  };
  EXPECT_THAT(read(" c_quat[1] c_quat[2] c_quat[3] c_quat[4]", " 1 0 0 0"),
              ElementsAre(HasSubstr("tell of orientations: c_quat[1..4]")));
  EXPECT_THAT(read(" f_fl[1] f_fl[2] f_fl[3] f_fl[4] f_fl[5] f_fl[6] f_fl[7]", " 0 0 0 0 0 0 0"),
              ElementsAre(HasSubstr("NAME:AXIS=POSITION:fix=f_fl takes")));
  EXPECT_THAT(read(" c_pe", " 0"), ElementsAre());
}

TEST_F(ImportColumns, VelocitiesAndImagesOfVtk) {
  for (const std::string name : {"v", "linVelVec", "vel"}) {
    const Outcome out = vtk(kRadius + ("VECTORS " + name + " double\n1 2 3\n4 5 6\n") +
                            "VECTORS omega double\n7 8 9\n0 0 0\n");
    const ImportedSnapshot one = only(out);
    ASSERT_EQ(one.snapshot.grains.size(), 2u) << name;
    EXPECT_EQ(one.snapshot.grains[0].velocity, dem::Vec3(1, 2, 3)) << name;
    EXPECT_EQ(one.snapshot.grains[0].angular_velocity, dem::Vec3(7, 8, 9));
    EXPECT_EQ(one.warnings, std::vector<std::string>{});
  }
  const Outcome images = import(
      "vtk",
      {write("i.vtk",
             "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n0 0 0\n0 0 "
             "0.0199\nPOINT_DATA 2\nSCALARS id int 1\nLOOKUP_TABLE default\n1 2\n" +
                 std::string(kRadius) + "VECTORS i int\n3 0 0\n0 0 0\n")},
      [](ImportOptions& o) {
        o.without_contacts = true;
        o.density = 2500;
        o.periodic = {parse_periodic("x=0:0.1")};
      });
  EXPECT_EQ(only(images).snapshot.grains[0].image[0], 3);
  // ParaView's tables of them.
  const ImportedSnapshot csv =
      only(grains("id,Points:0,Points:1,Points:2,radius,density,v:0,v:1,v:2\n1,0,0,0,1,1,1,2,3\n2,"
                  "0,0,1.9,1,1,0,"
                  "0,0\n"));
  EXPECT_EQ(csv.snapshot.grains[0].velocity, dem::Vec3(1, 2, 3));
}

TEST_F(ImportColumns, PlacesOfVtkBesideAnotherUnit) {
  EXPECT_THAT(warnings(vtk("SCALARS Diameter%20[mm] double 1\nLOOKUP_TABLE default\n20 20\n")),
              Contains(AllOf(HasSubstr("Diameter is in mm"), HasSubstr("x, y, z without a unit"))));
  EXPECT_THAT(warnings(vtk(kRadius, "all lengths in mm")),
              Contains(HasSubstr("g.vtk:2: found the unit mm in \"all lengths in mm\"")));
}

TEST_F(ImportColumns, BodiesOfSeveralGrains) {
  for (const std::string name : {"body", "mol", "rigid_id", "parent"}) {
    const auto text = [&](const std::string& third) {
      return "id,x,y,radius,mass," + name + "\n1,0,0,1,1,1\n2,0,2,1,1,1\n3,0,4,1,1," + third + "\n";
    };
    EXPECT_THAT(warnings(grains(text("2"))), ElementsAre(HasSubstr("grains of one rigid body")));
    // All in one: a default of the program.
    EXPECT_THAT(warnings(grains(text("1"))), ElementsAre());
  }
  EXPECT_THAT(
      warnings(import(
          "liggghts",
          {write("g.dump", atoms(0, "", "1 0 0 0.01 1 5\n2 0.02 0 0.01 1 5\n3 0.04 0 0.01 1 6\n",
                                 "id x y radius mass f_ms[1]"))},
          [](ImportOptions& o) { o.without_contacts = true; })),
      ElementsAre(HasSubstr("share numbers in the column f_ms[1]")));
}

TEST_F(ImportColumns, PartsBesideAForce) {
  EXPECT_THAT(contacts("i,j,fx,fy,p1,p2,p3\n1,2,-1,0,0,0.3,0\n").refused,
              AllOf(HasSubstr("beside fx the columns p1 p2 p3 may be the tangential part"),
                    HasSubstr("--column 'fx,fy=fx,fy' takes fx as the whole force")));
  EXPECT_THAT(contacts("i,j,fx,fy,fx_t,fy_t\n1,2,-1,0,0,0.3\n").refused,
              HasSubstr("--column 'ftx,fty=fx_t,fy_t' adds them"));
  const auto chosen = import(
      "csv", {write("g.csv", grains_), write("c.csv", "i,j,fx,fy,fx_t,fy_t\n1,2,-1,0,0,0.3\n")},
      [](ImportOptions& o) { o.columns = {"fx,fy=fx,fy"}; });
  EXPECT_EQ(only(chosen).snapshot.contacts[0].force, dem::Vec3(-1, 0, 0));
  // Sizes beside it are compared.
  EXPECT_THAT(contacts("i,j,fx,fy,ft\n1,2,-1,0,0.3\n").refused,
              HasSubstr("fx, fy, fz seem to be the normal part alone"));
  EXPECT_THAT(warnings(contacts("i,j,fx,fy,fn,ft\n1,2,-1,0.3,1,-0.3\n")),
              Not(Contains(HasSubstr("contradict"))));
  EXPECT_THAT(warnings(contacts("i,j,fx,fy,fn,ft\n1,2,-1,0.3,1,0.5\n")),
              Contains(HasSubstr("1 of 1 forces contradict the columns of their parts")));
  // Whole and parts.
  const std::string head = "i,j,fx,fy,fnx,fny,ftx,fty\n";
  EXPECT_EQ(contacts(head + "1,2,-1,0.3,-1,0,0,0.3\n").refused, "");
  EXPECT_THAT(contacts(head + "1,2,-1,0,-1,0,0,0.3\n").refused,
              HasSubstr("allowed: those that agree"));
  EXPECT_THAT(warnings(contacts("i,j,fx,fy,mz,torque_z\n1,2,-1,0,0,0\n")),
              Contains(HasSubstr("tell of torques: mz torque_z")));
}

TEST_F(ImportColumns, TheNormalPartOfALammpsPairAsTheWholeForce) {
  const Outcome out =
      import("lammps",
             {write("g.dump", atoms(0, "")),
              write("c.dump", entries(0, "1 2 -1 0 0 0 0.3 0\n",
                                      "id1 id2 c_p[1] c_p[2] c_p[3] c_p[4] c_p[5] c_p[6]"))},
             [](ImportOptions& o) { o.columns = {"fx,fy,fz=c_p[1..3]"}; });
  EXPECT_THAT(warnings(out), Contains(HasSubstr("p1 p2 p3 (here c_p[4..6]?)")));
}

TEST_F(ImportColumns, SizesOfForcesOnRoundGrainsNeedNoNormal) {
  const ImportedSnapshot one = only(contacts("i,j,fn,ft\n2,1,2,0.5\n"));
  ASSERT_EQ(one.snapshot.contacts.size(), 1u);
  EXPECT_NEAR(one.snapshot.contacts[0].force.x(), -2, 1e-15);
  // Along -n_y, n_x of the normal from 2 to 1, on 2.
  EXPECT_NEAR(one.snapshot.contacts[0].force.y(), 0.5, 1e-15);
}

TEST_F(ImportColumns, AllThatIsMissingAtOnceAndNoHintAtWhatIsTaken) {
  EXPECT_THAT(grains("id,X0,radus,mas\n1,0,1,1\n").refused,
              AllOf(HasSubstr("no columns \"x\", \"y\", \"radius\", \"mass\""),
                    HasSubstr("radius (radus)"), HasSubstr("x (X0)"), HasSubstr("mass (mas)")));
  EXPECT_THAT(contacts("i,j,fx\n1,2,0\n").refused,
              AllOf(HasSubstr("no column \"fy\""), Not(HasSubstr("nearest"))));
  EXPECT_THAT(
      contacts("i,j,fn\n1,2,0\n").refused,
      AllOf(HasSubstr("no column \"ft\""), Not(HasSubstr("nearest")), HasSubstr("--column ft=0")));
  EXPECT_THAT(grains("id,x,y,thing,mass\n1,0,0,1,1\n").refused,
              HasSubstr("not used so far: thing"));
  EXPECT_THAT(grains("id,x0,x1,radius,mass\n1,0,0,1,1\n").refused,
              AllOf(HasSubstr("x (x0)"), HasSubstr("y (x1)")));
  const auto named = import("csv", {write("g.csv", grains_)}, [](ImportOptions& o) {
    o.columns = {"radios=r", "massa=m"};
  });
  EXPECT_THAT(named.refused, AllOf(HasSubstr("unknown name \"radios\"; nearest: radius"),
                                   HasSubstr("unknown name \"massa\"; nearest: mass")));
}

TEST_F(ImportColumns, NamesWithCommas) {
  const auto read = [&](const std::vector<std::string>& columns) {
    return import("csv",
                  {write("g.csv", grains_), write("c.csv", "i,j,\"F, x\",\"F, y\"\n1,2,-1,0\n")},
                  [&](ImportOptions& o) { o.columns = columns; });
  };
  EXPECT_EQ(only(read({"fx=F, x", "fy=F, y"})).snapshot.contacts.size(), 1u);
  EXPECT_EQ(only(read({"fx,fy=\"F, x\",\"F, y\""})).snapshot.contacts.size(), 1u);
  EXPECT_THAT(read({"fx,fy=F, x,F, y"}).refused, HasSubstr("stands in quotation marks"));
}

}  // namespace
}  // namespace grainfield::coupling
