// Files as people have them: each habit that was reported, on packings of a few grains.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <sstream>

#include "coupling/import/packing_warnings.h"
#include "coupling/structure/packing_structure.h"
#include "dem/shapes/superellipsoid.h"
#include "tests/coupling/import_outcome.h"
#include "tests/coupling/import_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using testing::Folder;
using ::testing::HasSubstr;
using testing::Outcome;

class ImportHabits : public testing::ImportOfFiles {};

TEST_F(ImportHabits, TheTimeMayStandBeforeTheStep) {
  const std::string g = write(
      "g", atoms(1000, "ITEM: UNITS\nsi\nITEM: TIME\n0.05\n") + atoms(2000, "ITEM: TIME\n0.1\n"));
  const std::string c = write("c", entries(1000) + entries(2000));
  const auto all = [](ImportOptions& o) {
    o.all_steps = true;
    o.columns = {"fnx,fny=fx,fy", "ftx,fty=0,0"};
    o.time_step = 1e-3;
  };
  const Outcome outcome = import("lammps", {g, c}, all);
  ASSERT_EQ(outcome.packings.size(), 2u) << outcome.refused;
  EXPECT_EQ(outcome.packings[0].snapshot.time, 0.05);
  EXPECT_EQ(outcome.packings[1].snapshot.time, 0.1);
  // 1 s and 2 s by the option.
  EXPECT_THAT(outcome.packings[0].warnings, Contains(HasSubstr("the file's counts")));
}

TEST_F(ImportHabits, TheLastOfAStepThatIsThereTwiceCounts) {
  const std::string g = write("g", atoms(1000, "") + atoms(2000, "") +
                                       atoms(2000, "", "1 0 0.01 0.01 1\n2 0.0198 0.01 0.01 1\n"));
  const std::string c = write("c", entries(1000) + entries(2000) + entries(2000, "1 2 -2 0\n"));
  const Outcome outcome = import("lammps", {g, c}, [](ImportOptions& o) {
    o.columns = {"fnx,fny=fx,fy", "ftx,fty=0,0"};
  });
  const ImportedSnapshot& one = only(outcome);
  ASSERT_EQ(one.snapshot.contacts.size(), 1u);
  EXPECT_EQ(one.snapshot.contacts[0].force.x(), -2);
  EXPECT_EQ(one.snapshot.grains[1].position.x(), 0.0198);
  EXPECT_THAT(one.warnings, Contains(HasSubstr("step 2000 is there more than once")));
}

TEST_F(ImportHabits, AMeanStressThatPullsIsWarnedOfWithoutGravity) {
  const std::string g = write("g.csv", grains_),
                    c = write("c.csv", "end1,end2,force_x,force_y\n1,2,1,0\n");
  const Outcome outcome =
      import("csv", {g, c}, [](ImportOptions& o) { o.gravity = dem::Vec3(0, 0, 0); });
  const ImportedSnapshot& one = only(outcome);
  EXPECT_THAT(tension_in(check_packing(one.snapshot)), HasSubstr("mean stress is tension"));
  EXPECT_THAT(one.notes,
              Contains(::testing::AllOf(HasSubstr("i = end1"), HasSubstr("fx = force_x"))));
  const Outcome turned = import("csv", {g, c}, [](ImportOptions& o) {
    o.gravity = dem::Vec3(0, 0, 0);
    o.flip_forces = true;
  });
  EXPECT_EQ(tension_in(check_packing(only(turned).snapshot)), "");
}

TEST_F(ImportHabits, YadeWithoutIdsIsCountedOrNamesTheExport) {
  const std::string bodies =
      write("b", "#format x_y_z_r\n# settled column, t=2.0 s\n0 0 0.005 0.005\n0 0 0.0149 0.005\n");
  const std::string inter = write("i", "# id1 id2 fx fy fz\n0 1 0 0 1\n");
  const auto density = [](ImportOptions& o) { o.density = 2600; };
  EXPECT_THAT(import("yade", {bodies, inter}, density).refused, HasSubstr("export.textExt"));
  const Outcome alone = import("yade", {bodies}, [](ImportOptions& o) {
    o.density = 2600;
    o.without_contacts = true;
  });
  EXPECT_EQ(only(alone).snapshot.grains.size(), 2u);
  EXPECT_THAT(alone.packings[0].notes, Contains(HasSubstr("counted from 1")));
  const std::string attributes = write(
      "a", "#format x_y_z_r_attrs\n#id mass\n0 0 0.005 0.005 7 0.001\n0 0 0.0149 0.005 9 0.001\n");
  const std::string other = write("j", "# id1 id2 fx fy fz\n7 9 0 0 1\n");
  EXPECT_EQ(only(import("yade", {attributes, other})).snapshot.grains[1].id, 9);
  const std::string clumps =
      write("c", "#format id_x_y_z_r_clumpId\n0 0 0 0.005 0.005 0\n1 0 0 0.0149 0.005 0\n");
  const Outcome clumped = import("yade", {clumps, inter}, density);
  EXPECT_THAT(only(clumped).warnings, Contains(HasSubstr("clumpId")));
}

TEST_F(ImportHabits, PairsThatDoNotTouchAreNone) {
  const std::string g = write("g.csv",
                              "id,x,y,radius,mass\n1,0,0.01,0.01,1\n2,0.0199,0.01,0.01,1\n3,0.045,"
                              "0.01,0.01,1\n4,0.0648,0.01,0.01,1\n");
  const std::string c = write("c.csv", "i,j,fx,fy\n1,2,-1,0\n2,3,0,0\n3,4,0,0\n");
  const Outcome outcome = csv({g, c});
  const ImportedSnapshot& one = only(outcome);
  EXPECT_EQ(one.snapshot.contacts.size(), 2u);
  EXPECT_EQ(one.idle, 1);
  EXPECT_EQ(one.forceless, 1);
  // Across a gap a force is kept, and warned of.
  const Outcome bridge = csv({g, write("b.csv", "i,j,fx,fy\n1,2,-1,0\n2,3,1,0\n")});
  EXPECT_EQ(only(bridge).snapshot.contacts.size(), 2u);
  EXPECT_THAT(bridge.packings[0].warnings, Contains(HasSubstr("force across a gap")));
}

TEST_F(ImportHabits, StructureAndAverageLeaveOutPairsThatDoNotTouch) {
  dem::Snapshot s = test::overlapping_layer(3);
  const dem::Snapshot as_made = s;
  const PackingStructure before = packing_structure(s);
  long added = 0;
  for (std::size_t i = 0; i < s.grains.size(); ++i)
    for (std::size_t j = i + 1; j < s.grains.size(); ++j) {
      const dem::Vec3 branch = s.grains[j].position - s.grains[i].position;
      const double gap = branch.norm() - s.grains[i].radius - s.grains[j].radius;
      if (gap <= 1e-5 || gap > s.grains[i].radius) continue;
      dem::Contact c;
      c.i = static_cast<std::int64_t>(i);
      c.j = static_cast<std::int64_t>(j);
      c.normal = branch.normalized();
      c.point = s.grains[i].position + 0.5 * branch;
      s.contacts.push_back(c);
      ++added;
    }
  ASSERT_GT(added, 10);
  const Folder folder;
  dem::write_snapshot(folder / "in.h5", "/all", s);
  const testing::Output out = testing::program("structure " + (folder / "in.h5"));
  EXPECT_THAT(out.out, HasSubstr(fmt::format("coordination: {:.4g};", before.counts.mean)));
  EXPECT_THAT(out.err, HasSubstr(fmt::format("{} pairs bear no force and do not touch", added)));
  const testing::Output average =
      testing::program("average " + (folder / "in.h5") + " --grid 5x3 -o " + (folder / "out.h5"));
  EXPECT_THAT(average.err, HasSubstr("pairs bear no force and do not touch"));
}

TEST_F(ImportHabits, PackedTextIsReadAndCutOffTextIsRefused) {
  std::stringstream packed;
  {
    boost::iostreams::filtering_ostream in;
    in.push(boost::iostreams::gzip_compressor());
    in.push(packed);
    in << grains_;
  }
  const std::string c = write("c.csv", contacts_);
  EXPECT_EQ(only(csv({write("g.csv.gz", packed.str()), c})).snapshot.grains.size(), 2u);
  const std::string cut = packed.str().substr(0, packed.str().size() - 12);
  EXPECT_THAT(csv({write("h.csv.gz", cut), c}).refused, HasSubstr("damaged or cut off"));
  // The decompressor of zstd itself does not notice.
  std::stringstream frames;
  {
    boost::iostreams::filtering_ostream in;
    in.push(boost::iostreams::zstd_compressor());
    in.push(frames);
    in << grains_;
  }
  const std::string frame = frames.str();
  EXPECT_EQ(only(csv({write("g.csv.zst", frame), c})).snapshot.grains.size(), 2u);
  for (std::size_t kept = 4; kept < frame.size(); ++kept)
    EXPECT_THAT(csv({write("h.csv.zst", frame.substr(0, kept)), c}).refused,
                HasSubstr("damaged or cut off"))
        << kept;
  EXPECT_THAT(csv({write("i.csv", std::string("\x04\x22\x4d\x18 lz4", 8)), c}).refused,
              HasSubstr("lz4"));
  EXPECT_THAT(csv({write("j.csv", std::string("PK\x03\x04 xlsx", 9)), c}).refused,
              HasSubstr("ZIP"));
  EXPECT_THAT(import("lammps", {write("k.bin", std::string("\xd0\x07\0\0\0\0\0\0", 8)), c}).refused,
              HasSubstr("binary2txt"));
}

TEST_F(ImportHabits, SuperquadricsAreSuperellipsoids) {
  const auto dump = [](const std::string& columns, const std::string& rows) {
    return atoms(1, "", rows, columns);
  };
  const std::string columns =
      "id x y z radius mass shapex shapey shapez quat1 quat2 quat3 quat4 blockiness1 blockiness2";
  const std::string g =
      write("g", dump(columns,
                      "1 0 0 0.004 0.0108 0.00628 0.01 0.01 0.004 1 0 0 0 8 2\n"
                      "2 0 0 0.01199 0.0108 0.00628 0.01 0.01 0.004 1 0 0 0 8 2\n"));
  const std::string c = write("c", entries(1, "1 2 0 0 -0.06\n", "id1 id2 fx fy fz"));
  const Outcome outcome = import("liggghts", {g, c}, [](ImportOptions& o) { o.dim = 3; });
  const dem::Snapshot& s = only(outcome).snapshot;
  ASSERT_EQ(s.contacts.size(), 1u);
  const dem::Superellipsoid body = dem::superellipsoid({0.01, 0.01, 0.004}, {1, 0.25});
  EXPECT_NEAR(s.grains[0].volume, dem::volume_of(body), 1e-18);
  // One above the other: flat faces touch in the middle.
  EXPECT_NEAR(s.contacts[0].normal.z(), 1, 1e-9);
  EXPECT_NEAR(s.contacts[0].point.z(), 0.007995, 1e-8);
  // Without the shape's own columns a column of it is told.
  const std::string half = write("h", dump("id x y z radius mass blockiness1",
                                           "1 0 0 0.004 0.004 1 8\n2 0 0 0.0119 0.004 1 8\n"));
  const Outcome told = import("liggghts", {half, c}, [](ImportOptions& o) { o.dim = 3; });
  EXPECT_THAT(only(told).warnings, Contains(HasSubstr("blockiness1")));
}

TEST_F(ImportHabits, StepsOfDifferentIntervals) {
  std::string g, c;
  for (long step = 0; step <= 2500; step += 500) g += atoms(step, "");
  for (long step = 0; step <= 2500; step += 1000) c += entries(step);
  const std::vector<std::string> files{write("g", g), write("c", c)};
  const auto columns = [](ImportOptions& o) { o.columns = {"fnx,fny=fx,fy", "ftx,fty=0,0"}; };
  const Outcome last = import("lammps", files, columns);
  EXPECT_EQ(only(last).group, "/step_2000");
  EXPECT_THAT(last.packings[0].warnings, Contains(HasSubstr("2500")));
  const Outcome all = import("lammps", files, [&](ImportOptions& o) {
    columns(o);
    o.all_steps = true;
  });
  EXPECT_EQ(all.packings.size(), 3u);
  const Outcome asked = import("lammps", files, [&](ImportOptions& o) {
    columns(o);
    o.steps = {{1500, ""}};
  });
  EXPECT_THAT(asked.refused, HasSubstr("steps that have all tables: 0, 1000, 2000"));
}

TEST_F(ImportHabits, Spreadsheets) {
  const std::string c = write("c.csv", contacts_);
  const auto grains = [&](const std::string& text) { return csv({write("g.csv", text), c}); };
  const std::string rows = "1,0,0.01,0.01,1\n2,0.0199,0.01,0.01,1\n";
  for (const std::string& text : std::vector<std::string>{
           "sep=,\n" + grains_,
           grains_ + ",,,,\n,,,,\n",
           "Particle data at t = 2 s\n\n" + grains_,
           std::string(",id,x,y,radius,mass\n0,1,0,0.01,0.01,1\n1,2,0.0199,0.01,0.01,1\n"),
           "id,x,y,radius,mass\n-,m,m,m,kg\n" + rows,
           std::string("id,x,y,radius,mass\n-,mm,mm,mm,g\n1,0,10,10,1000\n2,19.9,10,10,1000\n"),
           std::string("id;x;y;radius;mass\n1;0;0,01;0,01;1\n2;0,0199;0,01;0,01;1\n"),
           std::string("id\tx\ty\tradius\tmass\n1\t0\t0.01\t0.01\t1\n2\t0.0199\t0.01\t0.01\t1\n"),
           "ID,X,Y,Radius,Mass\n" + rows,
           "Particle ID,Pos-X,pos_y,rad,Mass # five\n1,0,0.01,0.01,1 # "
           "first\n2,0.0199,0.01,0.01,1\n",
           "# id,x,y,radius,mass\n" + rows,
           std::string("id,x,y,radius,mass,note\n1,0,0.01,0.01,1,\"sand, "
                       "\"\"fine\"\"\"\n2,0.0199,0.01,0.01,1,\"two\nlines\"\n"),
       }) {
    const Outcome outcome = grains(text);
    ASSERT_EQ(outcome.refused, "") << text;
    const dem::Snapshot& s = outcome.packings[0].snapshot;
    ASSERT_EQ(s.grains.size(), 2u) << text;
    EXPECT_EQ(s.grains[1].position, dem::Vec3(0.0199, 0.01, 0)) << text;
    EXPECT_EQ(s.grains[1].mass, 1) << text;
  }
  EXPECT_THAT(grains("1,0,0.01,0.01,1\n2,0.0199,0.01,0.01,1\n").refused,
              HasSubstr("no line of names above"));
  EXPECT_THAT(grains("id;x;y;radius;mass\n1;0;0.01;0.01;1\n2;0,0199;0.01;0.01;1\n").refused,
              HasSubstr("read where no number of the table has a point"));
}

TEST_F(ImportHabits, NamesOfPairsAreThoseOfContacts) {
  const std::string g = write("g.csv", grains_);
  for (const char* names :
       {"id1,id2", "particle1,particle2", "end1,end2", "I,J", "Particle_i,Particle_j"})
    EXPECT_EQ(only(csv({g, write("c.csv", fmt::format("{},fx,fy\n1,2,-1,0\n", names))}))
                  .snapshot.contacts.size(),
              1u)
        << names;
  // Forces without places are contacts, whatever their ids are called.
  EXPECT_THAT(csv({g, write("d.csv", "first,second,fx,fy\n1,2,-1,0\n")}).refused,
              HasSubstr("no columns \"i\", \"j\""));
}

TEST_F(ImportHabits, IdsToTheLastDigit) {
  const auto pair = [&](const std::string& a, const std::string& b, const std::string& i,
                        const std::string& j) {
    return csv(
        {write("g.csv",
               fmt::format("id,x,y,radius,mass\n{},0,0.01,0.01,1\n{},0.0199,0.01,0.01,1\n", a, b)),
         write("c.csv", fmt::format("i,j,fx,fy\n{},{},-1,0\n", i, j))});
  };
  EXPECT_EQ(
      only(pair("9007199254740993", "9007199254740994", "9007199254740993", "9007199254740994"))
          .snapshot.grains[0]
          .id,
      9007199254740993);
  EXPECT_THAT(pair("9.007199254740993e15", "1", "1", "1").refused, HasSubstr("2^53"));
  EXPECT_EQ(only(pair("1.000e+00", "2.0", "1", "2.000000e+00")).snapshot.contacts.size(), 1u);
  // 1234567 and 1234568 are printed alike, 1234567 and 2234567 are not.
  EXPECT_THAT(pair("1234567", "1234568", "1.23457e+06", "1234568").refused,
              HasSubstr("any of 2 grains"));
  const Outcome told = pair("1234567", "2234567", "1.23457e+06", "2.23457e+06");
  EXPECT_EQ(only(told).snapshot.contacts.size(), 1u);
  EXPECT_THAT(told.packings[0].notes, Contains(HasSubstr("6 digits")));
}

TEST_F(ImportHabits, TheWallMayStandFirst) {
  const std::string g =
      write("g", "# id x y z r mass\n6 0 0 0.0049 0.005 1\n7 0 0 0.0148 0.005 1\n");
  const std::string c =
      write("c", "# id1 id2 fx fy fz nx ny nz\n2 6 0 0 2 0 0 1\n6 7 0 0 1 0 0 1\n");
  const Outcome outcome = import("yade", {g, c}, [](ImportOptions& o) {
    o.dim = 3;
    o.walls.push_back(parse_wall("floor:z=0:ids=0,1,2"));
  });
  const dem::Snapshot& s = only(outcome).snapshot;
  ASSERT_EQ(s.contacts.size(), 2u);
  EXPECT_LT(s.contacts[0].j, 0);
  EXPECT_EQ(s.contacts[0].force.z(), 2);  // YADE's act on the second body, here grain 6
  EXPECT_EQ(s.contacts[1].force.z(), -1);
}

TEST_F(ImportHabits, APairInBothDirectionsCountsOnce) {
  const std::string g = write("g.csv", grains_);
  const Outcome outcome = csv({g, write("c.csv", "i,j,fx,fy\n1,2,-1,0.25\n2,1,1,-0.25\n")});
  EXPECT_EQ(only(outcome).snapshot.contacts.size(), 1u);
  EXPECT_EQ(outcome.packings[0].twice, 1);
  EXPECT_THAT(csv({g, write("d.csv", "i,j,fx,fy\n1,2,-1,0.25\n2,1,-1,0.25\n")}).refused,
              HasSubstr("allowed: opposite forces"));
  EXPECT_THAT(csv({g, write("e.csv", "i,j,fx,fy\n1,2,-1,0.25\n1,2,-1,0.25\n")}).refused,
              HasSubstr("is there already"));
}

TEST_F(ImportHabits, ANarrowCellIsNamed) {
  const std::string g =
      write("g.csv", "id,x,y,z,radius,mass\n1,0.005,0,0.005,0.005,1\n2,0.0149,0,0.005,0.005,1\n");
  const auto narrow = [](double width) {
    return [width](ImportOptions& o) {
      o.dim = 3;
      o.periodic = {{0, 0, width, false}};
    };
  };
  const std::string itself = write("c.csv", "i,j,fx,fy,fz\n1,1,-2.5,0,0\n");
  EXPECT_THAT(import("csv", {g, itself}, narrow(0.0099)).refused,
              AnyOf(HasSubstr("0.0099 m along x"), HasSubstr("same centre")));
  // Two contacts of one pair, through two images: their points tell them apart.
  const std::string both =
      write("d.csv", "i,j,fx,fy,fz,px,py,pz\n1,2,-2,0,0,0.00995,0,0.005\n1,2,2,0,0,0,0,0.005\n");
  EXPECT_EQ(only(import("csv", {g, both}, narrow(0.0199))).snapshot.contacts.size(), 2u);
  // Without points their forces do, where they push to both sides.
  const auto without = [&](const char* second) {
    const std::string c =
        write("e.csv", fmt::format("i,j,fx,fy,fz\n1,2,-2,0,0\n1,2,{},0,0\n", second));
    return import("csv", {g, c}, narrow(0.0199));
  };
  EXPECT_EQ(only(without("2")).snapshot.contacts.size(), 2u);
  EXPECT_THAT(without("-1").refused, HasSubstr("0.0199 m"));
}

TEST_F(ImportHabits, DumpsWithOldHeadersAndBlankLines) {
  const std::string c = write("c", entries(2000));
  const auto columns = [](ImportOptions& o) { o.columns = {"fnx,fny=fx,fy", "ftx,fty=0,0"}; };
  const auto read = [&](const std::string& text) {
    return import("lammps", {write("g", text), c}, columns);
  };
  EXPECT_EQ(only(read("\xEF\xBB\xBF" + atoms(2000, "") + "\n\n")).snapshot.grains.size(), 2u);
  std::string old = atoms(2000, "");
  old.replace(old.find(" ff ff ff"), 9, "");
  EXPECT_EQ(only(read(old)).snapshot.grains.size(), 2u);
  std::string real = atoms(2000, "");
  real.replace(real.find("2000"), 4, "2000.0");
  EXPECT_EQ(only(read(real)).group, "/step_2000");
  EXPECT_THAT(read("---\ncreator: LAMMPS\n").refused, HasSubstr("yaml"));
  EXPECT_THAT(read("ITEM: UNITS\nlj\n" + atoms(2000, "")).refused, HasSubstr("allowed: si, cgs"));
  const Outcome cgs =
      read("ITEM: UNITS\ncgs\n" + atoms(2000, "", "1 0 1 1 1000\n2 1.99 1 1 1000\n"));
  EXPECT_EQ(only(cgs).snapshot.grains[1].position.x(), 0.0199);
  EXPECT_EQ(cgs.packings[0].snapshot.grains[1].mass, 1);
  // The contacts' dump says nothing: its forces are dyn, too.
  EXPECT_EQ(cgs.packings[0].snapshot.contacts[0].force.x(), -1e-5);
  EXPECT_THAT(cgs.packings[0].notes, Contains(HasSubstr("says no units")));
}

// Every file was kept open once.
TEST_F(ImportHabits, ThousandsOfFiles) {
  std::vector<std::string> files;
  for (long step = 0; step < 1200; ++step) {
    files.push_back(write(fmt::format("g{}", step), atoms(step, "")));
    files.push_back(write(fmt::format("c{}", step), entries(step)));
  }
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  rlimit few = before;
  few.rlim_cur = 64;
  setrlimit(RLIMIT_NOFILE, &few);
  long met = 0;
  std::size_t told = 0;
  ImportOptions options;
  options.format = "lammps";
  options.files = files;
  options.all_steps = true;
  options.columns = {"fnx,fny=fx,fy", "ftx,fty=0,0"};
  options.progress = [&](const char*, std::size_t, std::size_t) { ++told; };
  import_snapshots(options, [&](ImportedSnapshot&&) { ++met; });
  setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_EQ(met, 1200);
  EXPECT_EQ(told, 3600u);
}

TEST_F(ImportHabits, PlaneSpheresHaveTheDensityOfSpheres) {
  // LAMMPS in 2D: spheres of 2500 kg/m3, 2 mm wide.
  const double mass = 2500 * 4.0 / 3 * M_PI * 1e-9;
  const std::string g = write(
      "g.csv",
      fmt::format("id,x,y,radius,mass\n1,0,0.001,0.001,{0}\n2,0.00199,0.001,0.001,{0}\n", mass));
  EXPECT_EQ(strange_units(only(csv({g, write("c.csv", contacts_)})).snapshot), "");
}

}  // namespace
}  // namespace grainfield::coupling
