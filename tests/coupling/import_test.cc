// Our own packings through every foreign format and back, and mistakes in foreign files.
#include "coupling/import/import.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "coupling/averaging/average.h"
#include "import_scene.h"
#include "program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;
using ::testing::StartsWith;

// Stress and the other fields of both, over the whole layer: equal to 1e-12 of the largest value.
void expect_same_fields(const dem::Snapshot& ours, const dem::Snapshot& imported) {
  ASSERT_EQ(imported.grains.size(), ours.grains.size());
  ASSERT_EQ(imported.contacts.size(), ours.contacts.size());
  const Eigen::MatrixXd points = grid_points(0.01, 0.11, 9, 0.005, 0.055, 6);
  for (const char* method : {"coarse_graining", "particle_centre"}) {
    AverageOptions options;
    options.method = method;
    options.kernel = options.method == "particle_centre" ? "square" : "lucy";
    options.width = 0.015;
    const Field a = average(ours, points, options), b = average(imported, points, options);
    for (const Column& column : a.columns) {
      const Eigen::VectorXd& value = b.find(column.name)->value;
      double scale = 0;
      for (Eigen::Index k = 0; k < value.size(); ++k)
        if (!std::isnan(value[k])) scale = std::max(scale, std::abs(column.value[k]));
      for (Eigen::Index k = 0; k < value.size(); ++k) {
        ASSERT_EQ(std::isnan(value[k]), std::isnan(column.value[k])) << column.name;
        if (std::isnan(value[k])) continue;
        ASSERT_NEAR(value[k], column.value[k], 1e-12 * scale) << method << " " << column.name;
      }
    }
  }
}

dem::Snapshot import_one(const Folder& folder, const std::string& arguments) {
  const Output output = program("import " + arguments + " -o " + (folder / "in.h5"));
  EXPECT_EQ(output.code, 0) << output.err;
  // Made-up packings may be warned of, no more.
  std::istringstream lines(output.err);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_THAT(line, StartsWith("grainfield: warning: "));
  }
  const auto groups = dem::list_snapshots(folder / "in.h5");
  EXPECT_EQ(groups.size(), 1u);
  return dem::read_snapshot(folder / "in.h5", groups.at(0));
}

const char* axis_walls =
    " --wall floor:y=0:ids=0,9000 --wall left:x=0:ids=1,9001"
    " --wall right:x=0.12:ids=2,9002";
const char* fix_walls =
    " --wall floor:y=0:fix=f_floor --wall left:x=0:fix=f_left"
    " --wall right:x=0.12:fix=f_right";

TEST(Import, SaysTheSizesAndDoubtsUnitsThatAreHardlySI) {
  const Folder folder;
  const auto imported = [&](double radius, double mass) {
    const std::string rows = fmt::format("id,x,y,radius,mass\n0,0,0,{0},{1}\n1,{2},0,{0},{1}\n",
                                         radius, mass, 2 * radius);
    return program("import --from csv --without-contacts " + folder.write("g.csv", rows) + " -o " +
                   (folder / "in.h5"));
  };
  const Output si = imported(0.001, M_PI * 1e-6 * 5000);
  EXPECT_THAT(si.out, HasSubstr("mean diameter 0.002 m, density 5000 kg/m2"));
  EXPECT_EQ(si.err, "");
  const Output reduced = imported(0.5, M_PI / 4);  // Lennard-Jones units
  EXPECT_EQ(reduced.code, 0);
  EXPECT_THAT(reduced.err, HasSubstr("mean density 1 kg/m2, where grains have 10 to 30000"));
  const Output large = imported(500, M_PI * 250000 * 5000);
  EXPECT_THAT(large.err, HasSubstr("mean diameter 1e+03 m, where grains have 1e-07 to 100"));
}

TEST(Import, EveryFormatGivesBackTheStress) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const dem::Snapshot ours = test::overlapping_layer(seed);
    const Folder folder;
    const std::string csv = folder.write("grains.csv", test::csv_grains(ours)) + " " +
                            folder.write("contacts.csv", test::csv_contacts(ours)) + " " +
                            folder.write("walls.csv", test::csv_walls(ours));
    expect_same_fields(ours, import_one(folder, "--from csv " + csv));
    const std::string lammps = folder.write("l.grains", test::dump_grains(ours, 100, true)) + " " +
                               folder.write("l.contacts", test::lammps_contacts(ours, 100));
    expect_same_fields(
        ours, import_one(folder, "--from lammps " + lammps + test::lammps_columns + fix_walls));
    const std::string liggghts = folder.write("g.grains", test::dump_grains(ours, 100, false)) +
                                 " " +
                                 folder.write("g.contacts", test::liggghts_contacts(ours, 100)) +
                                 " " + folder.write("g.walls", test::liggghts_walls(ours, 100));
    expect_same_fields(ours, import_one(folder, "--from liggghts " + liggghts +
                                                    test::liggghts_columns + axis_walls));
    const std::string yade = folder.write("y.bodies", test::yade_bodies(ours)) + " " +
                             folder.write("y.inter", test::yade_interactions(ours));
    expect_same_fields(ours, import_one(folder, "--from yade " + yade + axis_walls));
  }
}

TEST(Import, FixedGrainsMakeARoughFloor) {
  const dem::Snapshot ours = test::overlapping_layer(4, 12, 6, true, 2.5);
  const Folder folder;
  const std::string files = folder.write("l.grains", test::dump_grains(ours, 0, true)) + " " +
                            folder.write("l.contacts", test::lammps_contacts(ours, 0));
  const dem::Snapshot imported = import_one(
      folder,
      "--from lammps --fixed type=2 --wall left:x=0:fix=f_left --wall right:x=0.12:fix=f_right"
      " --load 66=0,-2.5 " +
          files + test::lammps_columns);
  EXPECT_EQ(imported.loaded_grain, ours.loaded_grain);
  expect_same_fields(ours, imported);
  EXPECT_LT(check_packing(imported).unbalanced_force_ratio, 1e-12);
}

TEST(Import, CsvKeepsEveryBit) {
  dem::Snapshot ours = test::overlapping_layer(5);
  for (std::size_t k = 0; k < ours.contacts.size(); ++k) {
    ours.contacts[k].friction = 0.3;
    ours.contacts[k].spring = 0.1 * static_cast<double>(k);
    ours.contacts[k].sliding = k % 3 == 0;
  }
  for (std::size_t k = 0; k < ours.grains.size(); ++k) {
    ours.grains[k].id = 3 * ours.grains[k].id + 7;
    ours.grains[k].velocity = {1e-5 * static_cast<double>(k), -2e-7, 0};
    ours.grains[k].angle = 0.1;
    ours.grains[k].spin = -1.0 / 3;
  }
  const Folder folder;
  // Contacts before grains: the order of the files does not matter.
  const dem::Snapshot in = import_one(folder, "--from csv --gravity 0,-9.81 " +
                                                  folder.write("c", test::csv_contacts(ours)) +
                                                  " " + folder.write("w", test::csv_walls(ours)) +
                                                  " " + folder.write("g", test::csv_grains(ours)));
  EXPECT_EQ(in.dim, 2);
  EXPECT_EQ(in.gravity, ours.gravity);
  for (std::size_t k = 0; k < ours.grains.size(); ++k) {
    const dem::Grain &a = ours.grains[k], &b = in.grains[k];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.angle, b.angle);
    EXPECT_EQ(a.spin, b.spin);
    EXPECT_EQ(a.radius, b.radius);
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_EQ(a.inertia, b.inertia);
    EXPECT_EQ(a.volume, b.volume);
  }
  std::vector<bool> met(ours.contacts.size(), false);
  for (const dem::Contact& b : in.contacts) {
    for (std::size_t k = 0; k < ours.contacts.size(); ++k) {
      const dem::Contact& a = ours.contacts[k];
      if (a.i != b.i || a.j != b.j) continue;
      met[k] = true;
      EXPECT_EQ(a.point, b.point);
      EXPECT_EQ(a.normal, b.normal);
      EXPECT_EQ(a.force, b.force);
      EXPECT_EQ(a.spring, b.spring);
      EXPECT_EQ(a.friction, b.friction);
      EXPECT_EQ(a.sliding, b.sliding);
    }
  }
  EXPECT_EQ(std::count(met.begin(), met.end(), true), static_cast<long>(ours.contacts.size()));
}

TEST(Import, PolygonsInCsv) {
  const Folder folder;
  // A unit square given about its corner, turned by a right angle; a triangle, clockwise.
  const std::string grains = folder.write(
      "g",
      "id,x,y,angle,radius,density,outline\n"
      "1,10,0,1.5707963267948966,,2000,0 0;1 0;1 1;0 1\n2,9.5,1.5,0,,1000,-1 -0.5;0 1;1 -0.5\n"
      "3,0,0,0,0.5,1000,\n");
  const std::string contacts =
      folder.write("c", "i,j,px,py,nx,ny,fx,fy\n2,1,9.5,1,0,-2,0.5,7\n1,3,5,5,-1,0,1,0\n");
  const dem::Snapshot s =
      import_one(folder, "--from csv --leave-out-distant " + grains + " " + contacts);
  EXPECT_NEAR(s.grains[0].position.x(), 9.5, 1e-15);  // corner + turned centroid
  EXPECT_NEAR(s.grains[0].position.y(), 0.5, 1e-15);
  EXPECT_NEAR(s.grains[0].volume, 1, 1e-15);
  EXPECT_NEAR(s.grains[0].mass, 2000, 1e-12);
  EXPECT_NEAR(s.grains[0].inertia, 2000.0 / 6, 1e-12);  // m a^2 / 6
  EXPECT_NEAR(s.grains[0].radius, std::sqrt(0.5), 1e-15);
  ASSERT_EQ(s.grains[1].outline.size(), 3u);
  EXPECT_NEAR(s.grains[1].volume, 1.5, 1e-15);
  EXPECT_TRUE(s.grains[2].outline.empty());
  ASSERT_EQ(s.contacts.size(), 1u);  // the other one is far from both grains
  EXPECT_EQ(s.contacts[0].i, 0);     // ids 2 and 1 swapped, force and normal turned
  EXPECT_EQ(s.contacts[0].force, dem::Vec3(-0.5, -7, 0));
  EXPECT_EQ(s.contacts[0].normal, dem::Vec3(0, 1, 0));
  EXPECT_EQ(s.contacts[0].normal_force, 7);
  EXPECT_EQ(s.contacts[0].tangential_force, 0.5);  // along (-n_y, n_x) = (-1, 0)
  EXPECT_TRUE(std::isnan(s.contacts[0].friction));
}

TEST(Import, SpheresInSpace) {
  const Folder folder;
  const std::string grains = folder.write("g", "#format id_x_y_z_r\n4 0 0 0 1\n7 0 0 2.4 1.5\n");
  const std::string contacts =
      folder.write("c", "# id1 id2 fnx fny fnz ftx fty ftz\n7 4 0 0 -5 3 4 0\n");
  const dem::Snapshot s =
      import_one(folder, "--from yade --density 2600 --friction 1 " + grains + " " + contacts);
  EXPECT_EQ(s.dim, 3);
  EXPECT_EQ(s.gravity, dem::Vec3(0, 0, -9.81));
  EXPECT_NEAR(s.grains[1].volume, 4.5 * std::numbers::pi, 1e-14);
  EXPECT_NEAR(s.grains[1].mass, 2600 * 4.5 * std::numbers::pi, 1e-10);
  EXPECT_NEAR(s.grains[0].inertia, 0.4 * s.grains[0].mass, 1e-12);
  ASSERT_EQ(s.contacts.size(), 1u);
  // The force acts on the second body, 4, which is our first.
  EXPECT_EQ(s.contacts[0].force, dem::Vec3(3, 4, -5));
  EXPECT_EQ(s.contacts[0].normal, dem::Vec3(0, 0, 1));
  EXPECT_EQ(s.contacts[0].normal_force, 5);
  EXPECT_EQ(s.contacts[0].tangential_force, 5);
  EXPECT_TRUE(s.contacts[0].sliding);
  // Where the spheres cross: x^2 + z^2 = 1 and x^2 + (z - 2.4)^2 = 2.25.
  EXPECT_NEAR(s.contacts[0].point.z(), (5.76 + 1 - 2.25) / 4.8, 1e-15);
}

TEST(Import, StepsOfADump) {
  const dem::Snapshot ours = test::overlapping_layer(6, 4, 2);
  const Folder folder;
  std::string grains, contacts;
  for (long step : {0, 50, 200}) {
    dem::Snapshot moved = ours;
    for (dem::Grain& g : moved.grains) g.position.x() += 1e-3 * static_cast<double>(step);
    grains += test::dump_grains(moved, step, false);
    contacts += test::lammps_contacts(ours, step);
  }
  const std::string files = folder.write("g", grains) + " " + folder.write("c", contacts) +
                            test::lammps_columns + " -o " + (folder / "s.h5");
  const auto import = [&](const std::string& more) {
    return program("import --from lammps " + more + " " + files);
  };
  const auto groups = [&] { return dem::list_snapshots(folder / "s.h5"); };
  ASSERT_EQ(import("").code, 0);
  EXPECT_THAT(groups(), ::testing::ElementsAre("/step_200"));
  ASSERT_EQ(import("--step all --time-step 1e-3").code, 0);
  EXPECT_THAT(groups(), ::testing::ElementsAre("/step_0", "/step_200", "/step_50"));
  const dem::Snapshot at_50 = dem::read_snapshot(folder / "s.h5", "/step_50");
  EXPECT_EQ(at_50.grains[0].position.x(), ours.grains[0].position.x() + 0.05);
  EXPECT_DOUBLE_EQ(at_50.time, 0.05);
  ASSERT_EQ(import("--step 200=a/loaded --step 50=a/unloaded").code, 0);
  EXPECT_THAT(groups(), ::testing::ElementsAre("/a/loaded", "/a/unloaded"));
  ASSERT_EQ(import("--add --step 0 --group a/start").code, 0);
  EXPECT_EQ(groups().size(), 3u);
  EXPECT_THAT(import("--add --step 0 --group a/start").err,
              HasSubstr("holds a snapshot /a/start already"));
  EXPECT_EQ(groups().size(), 3u);
  EXPECT_THAT(import("--step 51").err,
              HasSubstr("--step 51: no such time step; there are: 0, 50, 200"));
}

// Files of two grains and a wall, one line of them changed, and what is said about it.
struct Mistake {
  std::string grains, contacts, options, words;
};

void expect_refused(const std::string& format, const Mistake& m) {
  const Folder folder;
  std::string files;
  if (!m.grains.empty()) files += " " + folder.write("g.txt", m.grains);
  if (!m.contacts.empty()) files += " " + folder.write("c.txt", m.contacts);
  const Output output =
      program("import --from " + format + " " + m.options + files + " -o " + (folder / "o.h5"));
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_EQ(output.out, "");
  EXPECT_THAT(output.err, StartsWith("grainfield: "));
  EXPECT_THAT(output.err, HasSubstr(m.words));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  EXPECT_FALSE(testing::fs::exists(folder / "o.h5"));
  EXPECT_EQ(std::distance(testing::fs::directory_iterator(folder.path()),
                          testing::fs::directory_iterator()),
            static_cast<long>(!m.grains.empty()) + static_cast<long>(!m.contacts.empty()));
}

TEST(Import, NeverReplacesItsInput) {
  const Folder folder;
  const std::string grains = folder.write("g", "id,x,y,radius,mass\n1,0,0,1,1\n");
  const Output output = program("import --from csv --without-contacts " + grains + " -o " + grains);
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("is an input and would be replaced; name another file"));
  EXPECT_THAT(testing::read_text(grains), StartsWith("id,x,y"));
}

// The contact points say where the wall is, --wall says otherwise.
TEST(Import, WarnsOfAWallThatIsElsewhere) {
  const Folder folder;
  const std::string files =
      folder.write("g", "id,x,y,radius,mass\n1,0,1,1,10000\n2,5,1,1,10000\n") + " " +
      folder.write("c", "i,j,px,py,fx,fy\n1,floor,0,0,0,98100\n2,floor,5,0,0,98100\n") + " -o " +
      (folder / "o.h5");
  EXPECT_THAT(program("import --from csv --wall floor:y=-3 " + files).err,
              HasSubstr("2 of 2 contacts with walls are more than two radii off their wall: is it "
                        "where it says?"));
  EXPECT_EQ(program("import --from csv --wall floor:y=0 " + files).err, "");
}

TEST(Import, MistakesInCsv) {
  const std::string g = "id,x,y,radius,mass\n1,0,0,1,1\n2,0,1.9,1,1\n", c = "i,j,fx,fy\n1,2,0,-3\n";
  const std::vector<Mistake> mistakes{
      {"", c, "", "no table of grains in "},
      {g, "", "", "no table of contacts in "},
      {"# nothing\n", c, "", "g.txt: is empty, expected a header line such as id,x,y,radius,mass"},
      {"id,x,y,radius,mass\n", c, "", "the tables of grains hold no row"},
      {"id,x,y,radus,mass\n1,0,0,1,1\n", c, "",
       "g.txt:1: no column \"radius\"; found: id x y radus mass; nearest: radus; other names by "
       "--column radius=THEIRS"},
      {"id,x,y,R [m],mass\n1,0,0,1,1\n", c, "", "nearest: R [m]; other names by --column"},
      {"id,x,y,diam,mass\n1,0,0,1,1\n", c, "", "nearest: diam (--column diameter=diam); other"},
      {"particle,x,y,radius,mass\n1,0,0,1,1\n", c, "",
       "no column \"id\"; found: particle x y radius mass; nearest: particle"},
      {"id,pos_x,pos_y,radius,mass\n1,0,0,1,1\n", c, "", "nearest: pos_x"},
      {g, "i,j,force_x,force_y\n1,2,0,1\n", "", "nearest: force_x"},
      {"id,x,y,radius\n1,0,0,1\n", c, "", "or --density"},
      {g, "# c\ni,j,fx\n1,2,0\n", "", "c.txt:2: no column \"fy\"; found: i j fx; nearest: "},
      {g, "i,j,fnx,fny\n1,2,0,1\n", "", "without friction: --column ftx,fty,ftz=0,0,0"},
      {g + "3,0,abc,1,1\n", c, "", "g.txt:4: column y: found \"abc\", expected a finite number"},
      {g + "3,0,nan,1,1\n", c, "", "g.txt:4: column y: found \"nan\", expected a finite number"},
      {g + "3,0,1e999,1,1\n", c, "", "found \"1e999\", expected a finite number"},
      {g + "3,,0,1,1\n", c, "", "g.txt:4: column x: found \"\", expected a finite number"},
      {g + "3.5,0,0,1,1\n", c, "", "column id: found \"3.5\", expected a whole number"},
      {g + "3,0,0,1\n", c, "", "g.txt:4: 4 values where the header at line 1 names 5 columns"},
      {g + "1,5,5,1,1\n", c, "", "g.txt:4: grain 1 is there already, at "},
      {g + "3,0,0,0,1\n", c, "", "g.txt:4: grain 3: found radius 0 m, allowed: above 0"},
      {g + "3,0,0,1,-1\n", c, "", "g.txt:4: grain 3: found mass -1, allowed: above 0"},
      {g, c + "1,7,0,0\n", "",
       "c.txt:3: contact of the unknown grain 7; known: 2 grains with ids from 1 to 2, no walls "
       "(--wall)"},
      {g, c + "1,flor,0,0\n", "--wall floor:y=-1",
       "c.txt:3: contact with the unknown wall \"flor\"; known: 2 grains with ids from 1 to 2, "
       "walls floor"},
      {g, c + "2,2,0,0\n", "", "c.txt:3: grain 2 in contact with itself"},
      {g, c + "2,1,0,0\n", "", "c.txt:3: the contact of grains 1 and 2 is there already, at "},
      {g, c + "2,1,0,inf\n", "", "c.txt:3: column fy: found \"inf\""},
      {g, c + "1,floor,0,3\n", "--wall floor:y=-5",
       "c.txt:3: grain 1 of radius 1 m in contact with wall floor at a distance of 5 m: is the "
       "wall "
       "where it says?"},
      {g, c + "1,floor,0,3\n1,floor,0,3\n", "--wall floor:y=-1",
       "c.txt:4: the contact of grain 1 and wall floor is there already, at "},
      {"id,xs,ys,radius,mass\n1,0,0,1,1\n", c, "",
       "g.txt:1: no column \"x\"; xs is in units of the box: dump x y z (or xu yu zu), in m"},
      {g + "3,50,0,1,1\n", c + "1,3,0,0\n", "", "across a periodic boundary? --leave-out-distant"},
      {g, "i,j,nx,ny,px,py,fx,fy\n1,2,0,0,0,1,1,1\n", "",
       "c.txt:2: the contact's normal has length 0"},
      {g + "3,0,0,1,1\n", c + "1,3,0,0\n", "", "grains 1 and 3 have the same centre"},
      {"id,x,y,z,radius,mass\n1,0,0,0,1,1\n2,0,1.9,0.1,1,1\n", c, "--dim 2",
       "g.txt:3: grain 2 has z = 0.1, grain 1 has z = 0; 2D needs one z"},
      {"id,x,y,z,radius,mass\n1,0,0,0,1,1\n2,0,1.9,0.1,1,1\n", c, "", "c.txt:1: no column \"fz\""},
      {g, c, "--dim 3", "g.txt:1: no column \"z\""},
      {g, c, "--dim 4", "--dim: found 4, allowed: 2, 3"},
      {g, "i,j,fx,fy,fz\n1,2,0,-3,0.5\n", "", "c.txt:2: found a force of 0.5 N along z in 2D"},
      {"id,x,y,z,outline,mass\n1,0,0,0,0 0;1 0;0 1,1\n2,0,0,1,0 0;1 0;0 1,1\n", c, "",
       "g.txt:2: grain 1 is a polygon; 3D takes spheres"},
      {"id,x,y,outline,mass\n1,0,0,0 0;1 0;0,1\n", c, "",
       "g.txt:2: grain 1: corner 3 of the outline: found \"0\", expected two finite numbers"},
      {"id,x,y,outline,mass\n1,0,0,0 0;2 0;1 0.2;0 2,1\n", c, "", "g.txt:2: grain 1: "},
      {"id,x,y,outline,mass\n1,0,0,,1\n", c, "", "grain 1 has neither a radius nor an outline"},
      {"id,x,y,outline,mass\n1,0,0,-1 -1;1 -1;0 1,1\n2,0,1,-1 -1;1 -1;0 1,1\n", c, "",
       "c.txt:2: contact of grains 1 and 2: those of polygons need px, py, nx and ny"},
      {g, c, "--column radius", "--column: found \"radius\", expected OURS=THEIRS"},
      {g, c, "--column radios=r", "unknown name \"radios\"; nearest: radius"},
      {g, c, "--column i,j=a", "--column i,j=a: 2 names on the left, 1 on the right"},
      {g, c, "--column radius=r_p",
       "--column radius=r_p: no table that needs radius has a column \"r_p\""},
      {g, c, "--wall floor:w=0", "--wall: found \"floor:w=0\", expected NAME:AXIS=POSITION"},
      {g, c, "--wall floor:z=0", "--wall floor: a wall across z in a packing in 2D"},
      {g, c, "--gravity 1", "--gravity: found \"1\", expected X,Y or X,Y,Z"},
      {g, c, "--fixed type", "--fixed: found \"type\", expected COLUMN=VALUE"},
      {g, c, "--fixed type=2", "g.txt:1: no column \"type\"; found: id x y radius mass"},
      {g, c, "--step 5", "--step: the files of csv hold no time steps"},
      {g, c, "--load 9=0,1", "--load: unknown grain 9; known: 2 grains"},
      {g, c, "--density -1", "--density: found -1, allowed: above 0"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.grains + mistake.contacts + mistake.options);
    expect_refused("csv", mistake);
  }
  expect_refused(
      "cvs",
      {g, c, "",
       "--from: unknown format \"cvs\"; nearest: csv; allowed: lammps, liggghts, yade, csv"});
}

TEST(Import, MistakesInDumps) {
  const dem::Snapshot ours = test::overlapping_layer(8, 3, 2);
  const std::string g = test::dump_grains(ours, 7, false), c = test::lammps_contacts(ours, 7);
  const std::string columns = test::lammps_columns;
  const auto cut = [](std::string text, std::size_t bytes) {
    text.resize(text.size() - bytes);
    return text;
  };
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<Mistake> mistakes{
      {g, c, "", "c.txt:9: no column \"i\"; found: index c_ids[1] c_ids[2] c_p[1]"},
      {changed(g, " radius", " c_r"), c, columns,
       "g.txt:9: no column \"radius\"; found: id type x y z c_r mass; nearest: "},
      {cut(g, 1), c, columns,
       "truncated: step 7 has 6 rows announced, 5 there (the last one ends without a line end)"},
      {cut(g, 60), c, columns, "g.txt:15: truncated: step 7 has 6 rows announced, 5 there"},
      {g, cut(c, 200), columns, "truncated: step 7 has "},
      {g.substr(0, 30), c, columns, "g.txt:3: truncated: the file ends in the middle of a line"},
      {g + g.substr(0, 100), c, columns, "truncated"},
      {"", c, columns, "no table of grains of step 7 in "},
      {g, test::lammps_contacts(ours, 8), columns + " --step 7",
       "no table of contacts of step 7 in "},
      {"some text\n", c, columns,
       "g.txt:1: found \"some text\", expected \"ITEM: ...\"; is this a dump file?"},
      {"ITEM: UNITS\nlj\n" + g, c, columns, "g.txt:2: units \"lj\", expected si"},
      {changed(g, "NUMBER OF ATOMS\n6", "NUMBER OF ATOMS\nsix"), c, columns,
       "g.txt:4: found \"six\", expected the number of rows"},
      {changed(g, "NUMBER OF ATOMS\n6", "NUMBER OF ATOMS\n5"), c, columns,
       "expected \"ITEM: ...\""},
      {"ITEM: ATOMS id\n1\n", c, columns, "before ITEM: TIMESTEP and ITEM: NUMBER OF ..."},
      {g, c, columns + " --wall floor:y=0:fix=f_floor",
       "g.txt:9: no column \"f_floor[1]\"; found: id type"},
      {"\x1f\x8b\x08 compressed", c, columns, "is compressed (gzip); unpack it first"},
      {std::string(std::size_t{1} << 20, 'x'), c, columns,
       "g.txt:1: the line is longer than 1048575 bytes"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.words);
    expect_refused("lammps", mistake);
  }
  // An earlier step of a truncated dump can be had.
  const Folder folder;
  const std::string files = folder.write("g", g + cut(test::dump_grains(ours, 8, false), 5)) + " " +
                            folder.write("c", c + test::lammps_contacts(ours, 8)) + columns +
                            " -o " + (folder / "o.h5");
  EXPECT_EQ(program("import --from lammps --step 7 " + files).code, 0);
  EXPECT_EQ(program("import --from lammps " + files).code, 2);
  EXPECT_THAT(program("import --from lammps " + (folder / "none") + " -o x").err,
              HasSubstr("none: No such file"));
  EXPECT_THAT(program("import --from lammps " + folder.path() + " -o x").err,
              HasSubstr("is a folder"));
}

TEST(Import, MistakesInYade) {
  expect_refused(
      "yade",
      {"1 0 0 0 1\n", "# id1 id2 fx fy fz\n", "--density 1",
       "g.txt:1: no comment line above names the 5 columns; expected \"#format id_x_y_z_r\""});
  expect_refused("yade", {"#format x_y_z_r\n0 0 0 1\n", "# id1 id2 fx fy fz\n", "--density 1",
                          "g.txt:1: no column \"id\"; found: x y z r; nearest: "});
}

TEST(Import, UnixAndOtherLineEnds) {
  const Folder folder;
  const dem::Snapshot s = import_one(
      folder, "--from csv " +
                  folder.write("g", "id,x,y,radius,mass\r\n1,0,0,1,1\r\n\r\n 2 , 0,+1.9,\"1\",1") +
                  " " + folder.write("c", "\xEF\xBB\xBFi,j,fx,fy\r\n1,2,0,-3\r\n"));
  EXPECT_EQ(s.grains.size(), 2u);
  EXPECT_EQ(s.contacts.size(), 1u);
}

}  // namespace
}  // namespace grainfield::coupling
