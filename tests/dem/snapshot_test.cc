// Snapshots through HDF5 and back, and what is said of broken files.
#include "dem/snapshot/snapshot.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>

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

TEST_F(SnapshotFile, ComesBackBitForBit) {
  const Snapshot s = small_snapshot();
  write_snapshot(file_, "/realization_000/loaded", s);
  write_snapshot(file_, "/realization_000/unloaded", s);
  EXPECT_THAT(list_snapshots(file_),
              testing::ElementsAre("/realization_000/loaded", "/realization_000/unloaded"));
  const Snapshot t = read_snapshot(file_, "/realization_000/loaded");
  ASSERT_EQ(t.grains.size(), s.grains.size());
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    EXPECT_EQ(t.grains[k].position, s.grains[k].position);
    EXPECT_EQ(t.grains[k].angle, s.grains[k].angle);
    EXPECT_EQ(t.grains[k].mass, s.grains[k].mass);
    EXPECT_EQ(t.grains[k].fixed, s.grains[k].fixed);
  }
  ASSERT_EQ(t.contacts.size(), 2u);
  EXPECT_EQ(t.contacts[1].j, -2);
  EXPECT_EQ(t.contacts[0].force, s.contacts[0].force);
  EXPECT_TRUE(t.contacts[0].sliding);
  ASSERT_EQ(t.walls.size(), 2u);
  EXPECT_EQ(t.walls[1].name, "left");
  EXPECT_EQ(t.attributes, s.attributes);
  EXPECT_EQ(t.loaded_grain, 3);
  EXPECT_EQ(t.time, 1.25);
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

TEST_F(SnapshotFile, RefusesContactsOfUnknownGrains) {
  Snapshot s = small_snapshot();
  s.contacts[0].j = 20;
  write_snapshot(file_, "/loaded", s);
  EXPECT_THAT(message([&] { read_snapshot(file_, "/loaded"); }),
              testing::HasSubstr("unknown grain"));
}

}  // namespace
}  // namespace grainfield::dem
