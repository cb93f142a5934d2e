// Lengths of other units than m, by --units and by the headers of CSV tables.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dem/snapshot/snapshot.h"
#include "tests/coupling/import_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

dem::Snapshot imported(const Folder& folder, const std::string& arguments, Output* said = nullptr) {
  const Output output = program("import " + arguments + " -o " + (folder / "in.h5"));
  EXPECT_EQ(output.code, 0) << output.err;
  if (said != nullptr) *said = output;
  return dem::read_snapshot(folder / "in.h5", dem::list_snapshots(folder / "in.h5").at(0));
}

const std::string kContacts = "i,j,px,py,nx,ny,fx,fy\n1,2,0,3.6,0,1,0,-30\n1,floor,0,0,0,-1,0,60\n";

TEST(ImportUnits, MillimetresAreTheBitsOfMetres) {
  const Folder folder;
  const std::string grains =
      "id,x,y,vx,radius,mass,volume\n1,0,1.8,0.7,1.8,2,10.2\n2,0,5.4,0,1.8,2,\n";
  Output said;
  const dem::Snapshot s =
      imported(folder,
               "--from csv --units mm --wall floor:y=0 " + folder.write("g.csv", grains) + " " +
                   folder.write("c.csv", kContacts),
               &said);
  EXPECT_THAT(said.out, HasSubstr("mean diameter 0.0036 m"));
  EXPECT_THAT(said.out,
              HasSubstr("(the files are read as SI, lengths, velocities and volumes of mm)"));
  EXPECT_EQ(s.grains[0].radius, 0.0018);
  EXPECT_EQ(s.grains[1].position, dem::Vec3(0, 0.0054, 0));
  EXPECT_EQ(s.grains[0].velocity.x(), 0.0007);
  EXPECT_EQ(s.grains[0].mass, 2);
  EXPECT_NEAR(s.grains[0].volume, 10.2e-6, 1e-20);  // of the plane: mm2
  EXPECT_NEAR(s.grains[1].volume, M_PI * 1.8e-3 * 1.8e-3, 1e-18);
  const dem::Contact& pair = s.contacts.back();
  EXPECT_EQ(pair.point.y(), 0.0036);
  EXPECT_EQ(pair.force, dem::Vec3(0, -30, 0));
}

TEST(ImportUnits, HeadersNameTheirs) {
  const Folder folder;
  const std::string grains =
      "id (1),x (mm),y [mm],angle (deg),spin (deg/s),radius (um),density (g/cm2)\n"
      "1,0,1.8,90,180,1800,0.5\n2,0,5.4,0,0,1800,0.5\n";
  const std::string contacts =
      "i,j,px (cm),py (mm),nx,ny,fx (mN),fy (kN)\n1,2,0,3.6,0,1,7,-0.03\n1,floor,0,0,0,-1,0,0.06\n";
  const std::string walls = "name,x (m),y (mm),nx,ny\nfloor,0,0,0,1\n";
  // Those of the headers count more than --units.
  for (const char* units : {"", "--units cm "}) {
    const dem::Snapshot s =
        imported(folder, std::string("--from csv ") + units + folder.write("g.csv", grains) + " " +
                             folder.write("c.csv", contacts) + " " + folder.write("w.csv", walls));
    EXPECT_EQ(s.grains[1].position.y(), 0.0054);
    EXPECT_EQ(s.grains[0].radius, 0.0018);
    EXPECT_DOUBLE_EQ(s.grains[0].angle, M_PI / 2);
    EXPECT_DOUBLE_EQ(s.grains[0].spin, M_PI);
    EXPECT_DOUBLE_EQ(s.grains[0].mass, 5 * M_PI * 0.0018 * 0.0018);
    EXPECT_EQ(s.contacts.back().force, dem::Vec3(0.007, -30, 0));
    EXPECT_EQ(s.contacts.back().point, dem::Vec3(0, 0.0036, 0));
  }
}

TEST(ImportUnits, OutlinesAndChosenColumnsToo) {
  const Folder folder;
  const std::string grains =
      "id,a[0] (mm),a[1] (m),outline (mm),mass (g)\n1,10,0.02,-1 -1;1 -1;1 1;-1 1,3\n";
  const dem::Snapshot s = imported(folder, "--from csv --without-contacts --column 'x,y=a[0..1]' " +
                                               folder.write("g.csv", grains));
  EXPECT_DOUBLE_EQ(s.grains[0].position.x(), 0.01);
  EXPECT_DOUBLE_EQ(s.grains[0].position.y(), 0.02);
  EXPECT_NEAR(s.grains[0].volume, 4e-6, 1e-18);
  EXPECT_EQ(s.grains[0].mass, 0.003);
}

// A dump of millimetres: places, walls' points and the periodic cell.
TEST(ImportUnits, ADumpsPlacesWallsAndCell) {
  const dem::Snapshot ours = test::overlapping_layer(2);
  dem::Snapshot large = ours;
  for (dem::Grain& g : large.grains) {
    g.position *= 1000;
    g.radius *= 1000;
  }
  for (dem::Contact& c : large.contacts) c.point *= 1000;
  const Folder folder;
  const auto read = [&](const dem::Snapshot& s, const std::string& options) {
    return imported(folder, "--from lammps " + folder.write("g", test::dump_grains(s, 1, true)) +
                                " " + folder.write("c", test::lammps_contacts(s, 1)) +
                                test::lammps_columns + options);
  };
  const dem::Snapshot a = read(ours,
                               " --wall floor:y=0:fix=f_floor --wall left:x=0:fix=f_left "
                               "--wall right:x=0.12:fix=f_right");
  const dem::Snapshot b =
      read(large,
           " --units mm --wall floor:y=0:fix=f_floor --wall left:x=0:fix=f_left "
           "--wall 'right:x=120 mm:fix=f_right'");
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    EXPECT_LT((a.contacts[k].point - b.contacts[k].point).norm(), 1e-15);
    EXPECT_EQ(a.contacts[k].force, b.contacts[k].force);
  }
  const dem::Snapshot cell = imported(
      folder,
      "--from lammps --units mm --without-contacts " +
          folder.write("p",
                       "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp ff "
                       "pp\n-3 17\n0 9\n-1 1\nITEM: ATOMS id x y radius mass\n1 20 5 1 1e-2\n"));
  EXPECT_DOUBLE_EQ(cell.cell.low.x(), -0.003);
  EXPECT_DOUBLE_EQ(cell.cell.edges(0, 0), 0.02);
  EXPECT_NEAR(cell.grains[0].position.x(), 0, 1e-15);
}

// Numbers of options: with their unit beside --units; 0 and what is no length need none.
TEST(ImportUnits, NumbersOfOptionsNameTheirs) {
  const Folder folder;
  const std::string grains = "id,x,y\n1,0,1.8\n2,0,5.4\n";
  const dem::Snapshot s =
      imported(folder,
               "--from csv --units mm --wall floor:y=0 --column 'radius=1.8 mm' --column mass=2 "
               "--column vx=0 --column 'volume=10.2 mm2' --periodic 'x=-20 mm:20 mm' " +
                   folder.write("g.csv", grains) + " " + folder.write("c.csv", kContacts));
  EXPECT_EQ(s.grains[0].radius, 0.0018);
  EXPECT_EQ(s.grains[0].mass, 2);
  EXPECT_NEAR(s.grains[0].volume, 10.2e-6, 1e-20);
  EXPECT_EQ(s.cell.edges(0, 0), 0.04);
}

// --units leaves moments of inertia in kg m2: those of a table in kg mm2 are doubted.
TEST(ImportUnits, MomentsOfInertiaInAnotherUnitAreDoubted) {
  const Folder folder;
  const auto said = [&](const char* inertia) {
    Output out;
    imported(folder,
             "--from csv --units mm --without-contacts " +
                 folder.write("g.csv", std::string("id,x,y,radius,mass,inertia\n1,0,0,2,0.01,") +
                                           inertia + "\n2,9,0,2,0.01,\n"),
             &out);
    return out.err;
  };
  EXPECT_THAT(said("0.02"), HasSubstr("moments of inertia are 2.5e+05 times mass and radius "
                                      "squared in the mean, where grains have 0.0001 to 2: are "
                                      "they in kg m2"));
  EXPECT_EQ(said("2e-8"), "");
}

TEST(ImportUnits, WhatIsNoneIsSaidInALine) {
  const std::string unknown =
      ", of m g s N Pa J Hz rad deg, with n u m c d k M G before; convert the column\n";
  const auto head = [](const std::string& x, const std::string& more = "mass") {
    return fmt::format("id,{},y,radius,{}\n1,0,0,1,1\n", x, more);
  };
  const struct {
    std::string grains, options, words;
  } cases[] = {
      {head("x (inch)"), "",
       "g.csv:1: column x: found the unit \"inch\", allowed: m or another unit of that kind" +
           unknown},
      {head("x (kg)"), "", "column x: found the unit \"kg\", allowed: m or another"},
      {head("pos [s]"), "--column x=pos", "column pos (x): found the unit \"s\", allowed: m or"},
      {head("x", "mass (mN)"), "",
       "column mass: found the unit \"mN\", allowed: kg (2D: kg/m) or another"},
      {head("x", "density (kg)"), "",
       "column density: found the unit \"kg\", allowed: kg/m3 (2D: kg/m2) or another"},
      {head("x", "density (g/cm3)"), "",
       "g.csv:1: column density: found \"density (g/cm3)\" in a packing in 2D, allowed: density "
       "in kg/m2, volume in m2, mass in kg or kg/m\n"},
      {head("x", "mass,volume (mm2)") + "", "--dim 3", "no column \"z\""},
      {head("x", "mass,fixed (m)"), "",
       "column fixed: found the unit \"m\", allowed: none, a number without a unit\n"},
      {head("x (m),x (mm)"), "", "column \"x\" is there twice, allowed: once"},
      {"id,x (mm),y (mm),radius (m),mass\n1,ten,0,1,1\n", "",
       "g.csv:2: column x (mm) (x): found \"ten\", expected a finite number"},
      {"id,x (km),y (m),radius (m),mass\n1,1e308,0,1,1\n", "",
       "found \"1e308\", expected a finite number"},
      {head("x"), "--units inch",
       "--units: found \"inch\", allowed: m, cm, mm, um, nm, km, si, cgs, micro, nano\n"},
      {head("x"), "--units mm2/m", "--units: found \"mm2/m\", allowed: m, cm, mm"},
      {head("x"), "--units m2/m", "--units: found \"m2/m\", allowed: m, cm, mm"},
      {head("x"), "--units mm --wall floor:y=-12",
       "--wall floor: found a length without a unit beside --units mm, expected one behind a "
       "blank"},
      {head("x"), "--units mm --periodic x=0:9",
       "--periodic x: found a length without a unit beside --units mm, expected one behind a"},
      {"id,x,y,mass\n1,0,0,1\n", "--units mm --column radius=1.8",
       "--column radius=1.8: found a number without a unit beside --units, expected one behind a "
       "blank, of the kind m"},
      {head("x"), "--units mm --column volume=10", "--column volume=10: found a number without a"},
      {"id,x,y,mass\n1,0,0,1\n", "--column 'radius=1.8 kg'", "no column \"radius\""},
      {head("x"), "--units kg", "--units: found \"kg\", allowed: m, cm, mm"},
      {head("x"), "--wall 'floor:y=1 s'", "--wall: found \"floor:y=1 s\", expected NAME:AXIS"},
  };
  for (const auto& one : cases) {
    const Folder folder;
    const Output output = program("import --from csv --without-contacts " + one.options + " " +
                                  folder.write("g.csv", one.grains) + " -o " + (folder / "o.h5"));
    EXPECT_EQ(output.code, 2) << one.words;
    EXPECT_THAT(output.err, HasSubstr(one.words));
    EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
    EXPECT_FALSE(testing::fs::exists(folder / "o.h5"));
  }
  const Folder folder;
  const Output told = program(
      "import --from lammps --units mm --without-contacts " +
      folder.write("d",
                   "ITEM: UNITS\nsi\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX "
                   "BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS id x y radius mass\n1 0 0 1 1\n") +
      " -o " + (folder / "o.h5"));
  EXPECT_EQ(told.code, 2);
  EXPECT_THAT(told.err, HasSubstr("d:2: the file says that it is in si units, and --units mm"));
}

}  // namespace
}  // namespace grainfield::coupling
