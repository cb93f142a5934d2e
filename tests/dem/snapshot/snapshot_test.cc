// Snapshots through HDF5 and back, and what is said of broken files.
#include "dem/snapshot/snapshot.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>

#include "dem/hdf5/file.h"
#include "tests/dem/snapshot_scene.h"

namespace grainfield::dem {
namespace {

class SnapshotFile : public testing::Test {
 protected:
  void SetUp() override {
    directory_ = std::filesystem::temp_directory_path() /
                 ("grainfield_snapshot_" +
                  std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                  std::to_string(getpid()));
    std::filesystem::create_directories(directory_);
    file_ = directory_ / "snapshots.h5";
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  template <class Call>
  static std::string message(Call call) {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no std::invalid_argument";
  }

  std::filesystem::path directory_, file_;
};

// Every value, one by one: all differ from each other and from the defaults.
TEST_F(SnapshotFile, RefusesIdsThatAreNotInOrder) {
  for (const std::vector<std::int64_t>& ids :
       {std::vector<std::int64_t>{5, 3}, {2, 2}, {1, -4}, {-1}}) {
    Snapshot s = full_snapshot(3);
    s.also_loaded = ids;
    write_snapshot(file_, "/s", s);
    EXPECT_THAT(message([&] { read_snapshot(file_, "/s"); }),
                testing::HasSubstr("allowed: ids in ascending order"));
    std::filesystem::remove(file_);
  }
}

TEST_F(SnapshotFile, ComesBackBitForBit) {
  const auto texts = [](const Snapshot& s) {
    std::vector<std::string> all;
    visit_values(s, [&](const auto& value) {
      CheckpointWriter w;
      w.put(value);
      all.push_back(w.bytes());
    });
    return all;
  };
  for (const Snapshot& s : {small_snapshot(), full_snapshot(2), full_snapshot(3)}) {
    std::filesystem::remove(file_);
    write_snapshot(file_, "/realization_000/loaded", s);
    write_snapshot(file_, "/realization_000/unloaded", s);
    EXPECT_THAT(list_snapshots(file_),
                testing::ElementsAre("/realization_000/loaded", "/realization_000/unloaded"));
    const auto written = texts(s), read = texts(read_snapshot(file_, "/realization_000/loaded"));
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t k = 0; k < read.size(); ++k)
      EXPECT_TRUE(read[k] == written[k]) << "value " << k << " of a snapshot in " << s.dim << "D";
  }
}

// Whoever reads files of the first format reads those of plain packings in 2D.
TEST_F(SnapshotFile, OnlyWhatIsUsedIsWritten) {
  const auto columns = [&](const Snapshot& s) {
    std::filesystem::remove(file_);
    write_snapshot(file_, "/s", s);
    const hdf5::Handle in = hdf5::open_for_reading(file_);
    const hdf5::Handle group = hdf5::open_group(in, "/s");
    std::string found;
    for (int format = 1; format < 4; ++format)
      if (hdf5::attribute_is(group, "format", fmt::format("grainfield-snapshot-{}", format)))
        found += fmt::format("{}:", format);
    for (const char* name :
         {"grains/orientation", "grains/angular_velocity", "grains/moments", "grains/material",
          "grains/rotates", "grains/image", "contacts/spring_vector", "contacts/image",
          "walls/shape", "walls/material", "walls/velocity", "walls/force", "walls/triangles",
          "cell"})
      if (hdf5::has_link(group, std::string(name).substr(0, std::string(name).find('/'))) &&
          hdf5::has_link(group, name))
        found += fmt::format(" {}", name);
    return found;
  };
  EXPECT_EQ(columns(small_snapshot()), "1:");
  EXPECT_EQ(
      columns(full_snapshot(2)),
      "2: grains/material grains/rotates grains/image contacts/image walls/shape walls/material "
      "walls/velocity walls/force walls/triangles cell");
  Snapshot s = small_snapshot();
  s.dim = 3;
  EXPECT_EQ(columns(s),
            "2: grains/orientation grains/angular_velocity grains/moments contacts/spring_vector "
            "walls/force");
}

// As grainfield 1 wrote imported spheres.
TEST_F(SnapshotFile, SpheresOfTheFirstFormatAreRead) {
  Snapshot s = small_snapshot();
  s.dim = 3;
  for (Grain& g : s.grains) {
    g.spin = 3;
    g.inertia = 7;
  }
  s.contacts[0].spring = std::nan("");
  write_snapshot(file_, "/s", s);
  {
    const hdf5::Handle out = hdf5::open_for_adding(file_);
    for (const char* name : {"/s/grains/orientation", "/s/grains/angular_velocity",
                             "/s/grains/moments", "/s/contacts/spring_vector"})
      ASSERT_GE(H5Ldelete(out, name, H5P_DEFAULT), 0) << name;
  }
  // In the newer format they must be there.
  EXPECT_THAT(message([&] { read_snapshot(file_, "/s"); }), testing::HasSubstr("orientation"));
  {
    const hdf5::Handle out = hdf5::open_for_adding(file_);
    const hdf5::Handle group = hdf5::open_group(out, "/s");
    ASSERT_GE(H5Adelete(group, "format"), 0);
    hdf5::write_attribute(group, "format", "grainfield-snapshot-1");
  }
  const Snapshot t = read_snapshot(file_, "/s");
  EXPECT_EQ(t.grains[2].orientation, (std::array<double, 4>{1, 0, 0, 0}));
  EXPECT_EQ(t.grains[2].angular_velocity, Vec3(0, 0, 3));
  EXPECT_EQ(t.grains[2].moments, Vec3(7, 7, 7));
  EXPECT_TRUE(std::isnan(t.contacts[0].spring_vector.x()));
  EXPECT_EQ(t.contacts[1].spring_vector, Vec3(0, 0, 0));
}

TEST_F(SnapshotFile, SaysWhatIsWrong) {
  EXPECT_THAT(message([&] { read_snapshot("/nowhere/x.h5", "/loaded"); }),
              testing::HasSubstr("/nowhere/x.h5: no such file"));
  std::ofstream(file_) << "not hdf5";
  EXPECT_THAT(message([&] { read_snapshot(file_, "/loaded"); }),
              testing::HasSubstr("not an HDF5 file"));
  std::filesystem::remove(file_);
  write_snapshot(file_, "/loaded", small_snapshot());
  EXPECT_THAT(message([&] { read_snapshot(file_, "/unloaded"); }),
              testing::HasSubstr("the file has: /loaded"));
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  EXPECT_THAT(message([&] { read_snapshot(file_, "/loaded"); }),
              testing::HasSubstr("truncated or broken"));
}

// HDF5 holds back what it writes until the file is closed. A limit on the size of files stands for
// a disk that is full at any point of it.
TEST_F(SnapshotFile, AFullDiskIsSaid) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "HDF5 keeps what it could not write, which counts as leaks";
#endif
  write_snapshot(file_, "/end", small_snapshot());
  const auto size = std::filesystem::file_size(file_);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  for (int part = 0; part <= 10; ++part) {
    const std::string cut = directory_ / ("cut" + std::to_string(part) + ".h5");
    rlimit limit = old;
    limit.rlim_cur = part == 10 ? size : part * size / 10 + 1;
    setrlimit(RLIMIT_FSIZE, &limit);
    std::string said = "nothing";
    try {
      write_snapshot(cut, "/end", small_snapshot());
    } catch (const std::runtime_error& e) {
      said = e.what();
    }
    setrlimit(RLIMIT_FSIZE, &old);
    if (part == 10) {
      EXPECT_EQ(said, "nothing");
      EXPECT_EQ(read_snapshot(cut, "/end").grains.size(), small_snapshot().grains.size());
    } else {
      EXPECT_THAT(said, testing::HasSubstr("cannot")) << part;
    }
  }
  std::signal(SIGXFSZ, old_handler);
}

TEST_F(SnapshotFile, RefusesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto said = [&](const auto& spoil) {
    Snapshot s = small_snapshot();
    spoil(s);
    write_snapshot(file_, "/loaded", s);
    const std::string text = message([&] { read_snapshot(file_, "/loaded"); });
    std::filesystem::remove(file_);
    return text;
  };
  EXPECT_THAT(said([&](Snapshot& s) { s.grains[1].position.y() = nan; }),
              testing::HasSubstr(":/loaded: position of grain " +
                                 std::to_string(small_snapshot().grains[1].id) +
                                 " is nan; it must be a finite number"));
  EXPECT_THAT(said([&](Snapshot& s) { s.grains[0].mass = INFINITY; }),
              testing::HasSubstr("mass of grain " + std::to_string(small_snapshot().grains[0].id)));
  EXPECT_THAT(said([&](Snapshot& s) { s.contacts[1].force.x() = nan; }),
              testing::HasSubstr("force of contact 1 is nan"));
  EXPECT_THAT(said([&](Snapshot& s) { s.walls[1].point.x() = nan; }),
              testing::HasSubstr("point of wall 1 is nan"));
  EXPECT_THAT(said([&](Snapshot& s) { s.gravity.y() = nan; }), testing::HasSubstr("gravity"));
  EXPECT_THAT(said([&](Snapshot& s) { s.dim = 4; }),
              testing::HasSubstr("found dim 4, allowed: 2, 3"));
  // What another program does not tell.
  EXPECT_EQ(said([&](Snapshot& s) { s.contacts[0].spring = s.contacts[0].friction = nan; }),
            "no std::invalid_argument");
}

TEST_F(SnapshotFile, RefusesWhatCannotBe) {
  const auto said = [&](const auto& spoil) {
    Snapshot s = full_snapshot(3);
    spoil(s);
    write_snapshot(file_, "/s", s);
    const std::string text = message([&] { read_snapshot(file_, "/s"); });
    std::filesystem::remove(file_);
    return text;
  };
  using testing::HasSubstr;
  EXPECT_EQ(said([](Snapshot&) {}), "no std::invalid_argument");
  EXPECT_THAT(said([](Snapshot& s) {
                s.grains[3].orientation = {1, 1, 0, 0};
              }),
              HasSubstr(":/s: orientation of grain 3 has length 1.41421; it must be a unit "
                        "quaternion (w, x, y, z)"));
  EXPECT_THAT(said([](Snapshot& s) { s.grains[3].orientation[2] = NAN; }),
              HasSubstr("orientation of grain 3 is nan; it must be a finite number"));
  EXPECT_THAT(said([](Snapshot& s) { s.grains[5].id = 17; }),
              HasSubstr(":/s: id of the grains in rows 5 and 17 is 17; it must be another one for "
                        "every grain"));
  EXPECT_EQ(said([](Snapshot& s) { std::swap(s.grains[5].id, s.grains[17].id); }),
            "no std::invalid_argument");
  EXPECT_THAT(said([](Snapshot& s) { s.loaded_grain = 20; }),
              HasSubstr("loaded_grain is 20; it must be the id of a grain, or -1 for none"));
  EXPECT_THAT(said([](Snapshot& s) { s.loaded_grain = -2; }), HasSubstr("loaded_grain is -2"));
  EXPECT_THAT(said([](Snapshot& s) {
                s.also_loaded = {5, 20};
              }),
              HasSubstr("also_loaded is 20; it must be the id of a grain"));
  EXPECT_EQ(said([](Snapshot& s) { s.loaded_grain = -1; }), "no std::invalid_argument");
  EXPECT_THAT(said([](Snapshot& s) { s.grains[3].radius = 0; }),
              HasSubstr("radius of grain 3 is 0 m; it must be above 0"));
  EXPECT_THAT(said([](Snapshot& s) { s.grains[3].mass = 0; }),
              HasSubstr("mass of grain 3 is 0; it must be above 0"));
  EXPECT_THAT(said([](Snapshot& s) { s.grains[3].volume = -1; }),
              HasSubstr("volume of grain 3 is -1; it must be above 0"));
  EXPECT_THAT(said([](Snapshot& s) { s.grains[0].mass = -1; }),
              HasSubstr("mass of grain 0 is -1; it must be 0 or more for a fixed grain"));
  EXPECT_EQ(said([](Snapshot& s) { s.grains[0].mass = s.grains[0].volume = 0; }),  // fixed
            "no std::invalid_argument");
  EXPECT_THAT(said([](Snapshot& s) { s.contacts[1].normal *= 2; }),
              HasSubstr("normal of contact 1 has length 2; it must be a unit vector"));
  EXPECT_THAT(said([](Snapshot& s) { s.contacts[1].normal_force *= -1; }),
              HasSubstr("it must be what force and normal say, "));
  EXPECT_THAT(said([](Snapshot& s) { s.contacts[1].friction = -0.1; }),
              HasSubstr("friction of contact 1 is -0.1; it must be 0 or more"));
  EXPECT_THAT(said([](Snapshot& s) { s.contacts[1].friction = INFINITY; }),
              HasSubstr("friction of contact 1 is inf; it must be a finite number"));
  EXPECT_THAT(said([](Snapshot& s) { s.contacts[1].point.x() = 1e9; }),
              HasSubstr("point of contact 1 is 1e+09 m from a grain of its; it must be within 10 "
                        "radii, "));
  EXPECT_THAT(said([](Snapshot& s) { s.contacts[0].image[1] = 2000; }),
              HasSubstr("point of contact 0 is "));
  EXPECT_THAT(said([](Snapshot& s) {
                s.contacts[0].j = s.contacts[0].i;
                s.contacts[0].image = {0, 0, 0};
              }),
              HasSubstr("j of contact 0 is 3 as its i is; a grain does not touch itself"));
  EXPECT_THAT(said([](Snapshot& s) { s.walls[1].normal *= 1.1; }),
              HasSubstr("normal of wall left has length 1.1; it must be a unit vector"));
  EXPECT_THAT(said([](Snapshot& s) { s.walls[1].friction = -1; }),
              HasSubstr("friction of wall left is -1; it must be 0 or more"));
  EXPECT_THAT(said([](Snapshot& s) { s.contacts[1].force.x() = 1e200; }),
              HasSubstr("force of contact 1 is 1e+200; it must be of size 1e+100 at most"));
  EXPECT_THAT(said([](Snapshot& s) { s.grains[3].velocity.x() = -1e200; }),
              HasSubstr("velocity of grain 3 is -1e+200; it must be of size 1e+100 at most"));
  EXPECT_THAT(said([](Snapshot& s) { s.gravity.y() = 1e101; }),
              HasSubstr(":/s: attribute 'gravity_y' is 1e+101; it must be of size 1e+100 at most"));
  EXPECT_THAT(said([](Snapshot& s) { s.applied_force.z() = INFINITY; }),
              HasSubstr("attribute 'applied_force_z' is inf; it must be a finite number"));
  EXPECT_THAT(said([](Snapshot& s) { s.time = NAN; }), HasSubstr("attribute 'time' is nan"));
  EXPECT_THAT(said([](Snapshot& s) { s.grains[3].moments.y() = 0; }),
              HasSubstr("moments of grain 3 are "));
  EXPECT_EQ(said([](Snapshot& s) { s.grains[0].moments.y() = 0; }),  // fixed
            "no std::invalid_argument");
  EXPECT_THAT(said([](Snapshot& s) { s.walls[0].shape = "plain"; }),
              HasSubstr("shape of wall floor is \"plain\"; allowed: plane, cylinder, cone, mesh"));
  EXPECT_THAT(said([](Snapshot& s) { s.walls[2].radius = -1; }),
              HasSubstr("wall hopper is a cone of radii -1 and "));
  EXPECT_THAT(said([](Snapshot& s) { s.walls[2].shape = "cylinder", s.walls[2].radius = 0; }),
              HasSubstr("radius of wall hopper is 0 m; it must be above 0"));
  EXPECT_THAT(said([](Snapshot& s) { s.walls[3].triangles.clear(); }),
              HasSubstr("wall mesh is a mesh with 0 triangles"));
  EXPECT_THAT(said([](Snapshot& s) { s.walls[3].triangles[1][2].y() = INFINITY; }),
              HasSubstr("row 1 of triangles is inf"));
  EXPECT_THAT(said([](Snapshot& s) { s.walls[1].velocity.y() = INFINITY; }),
              HasSubstr("velocity of wall 1 is inf"));
  EXPECT_THAT(said([](Snapshot& s) { s.cell.edges.col(1) = 2 * s.cell.edges.col(0); }),
              HasSubstr("edge y of the cell is (4, 0, 0) m; periodic edges must span a space"));
  EXPECT_THAT(said([](Snapshot& s) { s.cell.edges.col(0).setZero(); }),
              HasSubstr("edge x of the cell is (0, 0, 0) m"));
  EXPECT_THAT(said([](Snapshot& s) { s.cell.low.x() = NAN; }),
              HasSubstr("the cell holds a number that is not finite"));
  EXPECT_THAT(said([](Snapshot& s) {
                s.contacts[0].image = {0, 0, 1};
              }),
              HasSubstr("image of contact 0 is 0, 0, 1; the cell is not periodic along z"));
  EXPECT_THAT(said([](Snapshot& s) {
                s.grains[1].image = {0, 0, -3};
              }),
              HasSubstr("the cell is not periodic along z"));
  EXPECT_THAT(said([](Snapshot& s) {
                s.contacts[1].image = {1, 0, 0};
              }),
              HasSubstr("image of contact 1 is 1, 0, 0; walls have no images"));
  EXPECT_EQ(said([](Snapshot& s) { s.contacts[0].spring_vector.setConstant(NAN); }),
            "no std::invalid_argument");
  Snapshot s = full_snapshot(2);
  s.cell.periodic[2] = true;
  write_snapshot(file_, "/s", s);
  EXPECT_THAT(message([&] { read_snapshot(file_, "/s"); }),
              HasSubstr("a cell in 2D is periodic along z"));
  s.grains[0].material = "a,b";
  EXPECT_THAT(message([&] { write_snapshot(file_, "/t", s); }),
              HasSubstr("material: found the name \"a,b\", allowed: names without commas"));
}

// Columns that do not belong together, as a foreign program may leave them.
TEST_F(SnapshotFile, RefusesTablesThatDoNotFit) {
  const auto said = [&](const char* column, const auto& values, int width) {
    std::filesystem::remove(file_);
    write_snapshot(file_, "/s", full_snapshot(3));
    const std::string group(column, std::string(column).find('/')),
        name(std::string(column).substr(group.size() + 1));
    {
      const hdf5::Handle out = hdf5::open_for_adding(file_);
      const hdf5::Handle in = hdf5::open_group(out, "/s/" + group);
      H5Ldelete(in, name.c_str(), H5P_DEFAULT);
      hdf5::write(in, name, values, width, "1");
    }
    return message([&] { read_snapshot(file_, "/s"); });
  };
  using testing::HasSubstr;
  using Whole = std::vector<long long>;
  using Real = std::vector<double>;
  EXPECT_THAT(said("grains/moments", Real(57, 1.0), 3),
              HasSubstr("grains/moments has 19 rows where 20 are expected"));
  EXPECT_THAT(said("grains/orientation", Real(60, 1.0), 3), HasSubstr("orientation"));
  EXPECT_THAT(
      said("grains/material", Whole(20, 2), 1),
      HasSubstr("material of grain 0 is 2; it must be a place in its list of names, or -1"));
  EXPECT_THAT(said("contacts/sliding", Whole{1, 7}, 1),
              HasSubstr("sliding of contact 1 is 7; it must be 0 or 1"));
  EXPECT_THAT(said("grains/fixed", Whole(20, -1), 1),
              HasSubstr("fixed of grain 0 is -1; it must be 0 or 1"));
  EXPECT_THAT(said("contacts/image", Whole(6, 1LL << 40), 3),
              HasSubstr("image of contact 0 is 1099511627776; it must be at most 1000000"));
  EXPECT_THAT(said("walls/triangles_start", Whole{0, 0, 2, 1, 3}, 1),
              HasSubstr("triangles_start does not fit triangles"));
  EXPECT_THAT(said("cell/edges", Real(6, 1.0), 3),
              HasSubstr("cell/edges has 2 rows where 3 are expected"));
  EXPECT_THAT(said("cell/low", Real(2, 1.0), 1), HasSubstr("cell/low has 2 rows"));
}

TEST_F(SnapshotFile, RefusesContactsOfUnknownGrains) {
  Snapshot s = small_snapshot();
  s.contacts[0].j = 20;
  write_snapshot(file_, "/loaded", s);
  EXPECT_THAT(message([&] { read_snapshot(file_, "/loaded"); }),
              testing::HasSubstr("unknown grain"));
}

}  // namespace
}  // namespace grainfield::dem
