// Our own packings through every foreign format and back.
#include "coupling/import/import.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <sstream>

#include "coupling/averaging/average.h"
#include "tests/coupling/import_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
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

const char* axis_walls =  // of LIGGGHTS' meshes
    " --wall floor:y=0:ids=0 --wall left:x=0:ids=1 --wall right:x=0.12:ids=2";
const char* body_walls =  // of YADE's bodies
    " --wall floor:y=0:ids=9000 --wall left:x=0:ids=9001 --wall right:x=0.12:ids=9002";
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

// "fix side all wall/gran ... xplane 0 0.12 contacts": one fix for two walls.
TEST(Import, OneFixOfTwoWallsIsCountedOnce) {
  const dem::Snapshot ours = test::overlapping_layer(1);
  std::string dump = test::dump_grains(ours, 100, true);
  // Columns of the two walls into those of one fix: of a grain, one of them is zeros.
  std::istringstream lines(dump);
  std::string joined;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    const std::vector<std::string> all{std::istream_iterator<std::string>(words), {}};
    if (all.size() < 9 || (all[0] == "ITEM:" && all[1] != "ATOMS")) {
      joined += line + "\n";
      continue;
    }
    const bool heads = all[0] == "ITEM:";
    const std::size_t own = (heads ? 2 : 0) + 7, left = own + 7, right = own + 14;
    const bool at_left = heads || all[left] != "0";
    for (std::size_t k = 0; k < right; ++k)
      joined += fmt::format("{} ", k < left || at_left ? all[k] : all[k + 7]);
    joined += "\n";
  }
  const Folder folder;
  const std::string files = folder.write("l.grains", joined) + " " +
                            folder.write("l.contacts", test::lammps_contacts(ours, 100));
  expect_same_fields(
      ours, import_one(folder, "--from lammps " + files + test::lammps_columns +
                                   " --wall floor:y=0:fix=f_floor --wall left:x=0:fix=f_left"
                                   " --wall right:x=0.12:fix=f_left"));
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
    expect_same_fields(ours, import_one(folder, "--from yade " + yade + body_walls));
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
  ASSERT_EQ(import("--step 200=a/loaded --step 50=a/unloaded --load 1=0,-3").code, 0);
  EXPECT_EQ(dem::read_snapshot(folder / "s.h5", "/a/loaded").applied_force.y(), -3);
  EXPECT_EQ(dem::read_snapshot(folder / "s.h5", "/a/unloaded").applied_force.norm(), 0);
  EXPECT_THAT(groups(), ::testing::ElementsAre("/a/loaded", "/a/unloaded"));
  ASSERT_EQ(import("--add --step 0 --group a/start").code, 0);
  EXPECT_EQ(groups().size(), 3u);
  EXPECT_THAT(import("--add --step 0 --group a/start").err,
              HasSubstr("holds a snapshot /a/start already"));
  EXPECT_EQ(groups().size(), 3u);
  EXPECT_THAT(import("--step 51").err,
              HasSubstr("--step 51: no such time step; there are: 0, 50, 200"));
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

// What can be taken and is doubtful.
TEST(Import, WarnsOfDoubtfulValues) {
  const std::string g = "id,x,y,radius,density\n1,0,1,1,5000\n2,0,2.9,1,5000\n";
  const auto warned = [](const std::string& grains, const std::string& contacts,
                         const std::string& options) {
    const Folder folder;
    const Output output =
        program("import --from csv " + folder.write("g.csv", grains) + " " +
                folder.write("c.csv", contacts) + " " + options + " -o " + (folder / "o.h5"));
    EXPECT_EQ(output.code, 0) << output.err;
    return output.err;
  };
  const auto one = [&](const std::string& row, const std::string& options = "") {
    return warned(g, "i,j,px,py,nx,ny,fx,fy\n" + row + "\n", options);
  };
  EXPECT_THAT(one("1,2,0,1.95,0,1,0,-3"), Not(HasSubstr("normal")));
  EXPECT_THAT(one("1,2,0,1.95,0,1.0001,0,-3"), Not(HasSubstr("normal")));
  EXPECT_THAT(
      one("1,2,0,1.95,0,3,0,-3"),
      HasSubstr("warning: /packing: 1 of 1 normals in the files are not of unit length (the "
                "first: 1 and 2, length 3); they were made so"));
  EXPECT_THAT(one("1,floor,0,0,1,0,0,3", "--wall floor:y=0"),
              HasSubstr("1 of 1 normals in the files at walls are more than 60 degrees off their "
                        "wall's (the first: 1 and floor)"));
  EXPECT_THAT(one("1,floor,0,0,0.1,-1,0,3", "--wall floor:y=0"), Not(HasSubstr("60 degrees")));
  // One grain far away of three; a period of two thirds of the packing's width.
  EXPECT_THAT(warned(g + "3,0,5e6,1,5000\n", "i,j,fx,fy\n1,2,0,-3\n", ""),
              HasSubstr("1 of 3 grains are more than 1e+06 median radii from the middle of the "
                        "packing (the first: 3)"));
  const std::string row = "id,x,y,radius,density\n1,1,1,1,5000\n2,3,1,1,5000\n3,5.5,1,1,5000\n";
  EXPECT_THAT(warned(row, "i,j,fx,fy\n1,2,-1,0\n", "--periodic x=0:6.5"),
              Not(HasSubstr("overlap")));
  EXPECT_THAT(
      warned(row, "i,j,fx,fy\n1,2,-1,0\n", "--periodic x=0:4"),
      HasSubstr("pairs of grains that overlap by more than half the smaller radius: 1 (the "
                "first: 1 and 3); are the radii diameters, or in another unit than the places, "
                "or is the period narrower than the packing?"));
  const auto sliding = [&](const char* force, int mark) {
    return warned(g, fmt::format("i,j,fx,fy,friction,sliding\n1,2,{},-3,0.5,{}\n", force, mark),
                  "");
  };
  EXPECT_THAT(sliding("2", 0),
              HasSubstr("1 of 1 contacts of known friction bear a tangential force beyond friction "
                        "times normal force and are not marked as sliding"));
  EXPECT_THAT(sliding("1.5", 0), Not(HasSubstr("friction")));
  EXPECT_THAT(sliding("2", 1), Not(HasSubstr("friction")));
}

TEST(Import, WarnsOfNormalsThatPointBackwards) {
  const Folder folder;
  const auto import = [&](const std::string& second, const char* normal) {
    return program(
        "import --from csv " +
        folder.write("g",
                     "id,x,y,radius,density,outline\n"
                     "1,0,0.5,,1000,-0.5 -0.5;0.5 -0.5;0.5 0.5;-0.5 0.5\n" +
                         second) +
        " " + folder.write("c", fmt::format("i,j,px,py,nx,ny,fx,fy\n1,2,0,1,{},0,-7\n", normal)) +
        " -o " + (folder / "o.h5"));
  };
  for (const char* second : {"2,0,1.49,0.5,1000,\n", "2,0,1.5,,1000,-1 -0.5;0 1;1 -0.5\n"}) {
    EXPECT_THAT(import(second, "0,-1").err,
                HasSubstr("1 of 1 contacts of polygons have a normal more than 90 degrees off the "
                          "line of centres (the first: 1 and 2); it points from i to j"));
    EXPECT_THAT(import(second, "0,1").err, Not(HasSubstr("normal")));
    EXPECT_THAT(import(second, "0.9,0.436").err, Not(HasSubstr("90 degrees")));
  }
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
