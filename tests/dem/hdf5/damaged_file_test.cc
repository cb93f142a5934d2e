// Snapshots with wrong bytes, foreign files, and files that HDF5 itself does not survive.
#include <gmock/gmock.h>
#include <pthread.h>
#include <sys/mman.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <new>
#include <thread>

#include "dem/hdf5/child.h"
#include "dem/hdf5/trial_read.h"
#include "tests/damaged_files.h"
#include "tests/dem/snapshot_scene.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

using grainfield::testing::bytes_of;
using grainfield::testing::TestFolder;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// Where these bytes stand in the file.
std::size_t find(const std::string& file, const std::string& bytes) {
  const std::size_t at = bytes_of(file).find(bytes);
  EXPECT_NE(at, std::string::npos);
  return at;
}

// Turns a bit of one byte.
void spoil(const std::string& file, std::size_t at) {
  std::string bytes = bytes_of(file);
  bytes.at(at) ^= 1;
  // Another file in its place, so that it is not taken for the one that was there.
  std::ofstream(file + ".new", std::ios::binary) << bytes;
  std::filesystem::rename(file + ".new", file);
}

std::string as_bytes(double value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

TEST(DamagedFile, AWrongByteIsNoticedOrChangesNothing) {
  const TestFolder folder;
  const std::string file = folder / "s.h5";
  write_snapshot(file, "/a/loaded", full_snapshot(3));
  grainfield::testing::Damage found;
  grainfield::testing::flip_bytes(file, folder, 601, true, bits_of_file, found);
  EXPECT_GT(found.copies, 200);
  EXPECT_GT(found.refused, found.copies / 4);  // many bytes are none of a value
}

TEST(DamagedFile, OneWithoutChecksumsDoesNotEndTheProgram) {
  const TestFolder folder;
  write_snapshot(folder / "s.h5", "/a/loaded", full_snapshot(3));
  const std::string plain = folder / "plain.h5";
  grainfield::testing::copy_plainly(folder / "s.h5", plain);
  EXPECT_TRUE(bits_of_file(plain) == bits_of_file(folder / "s.h5"));
  grainfield::testing::Damage found;
  grainfield::testing::flip_bytes(plain, folder, 131, false, bits_of_file, found);
  EXPECT_GT(found.copies, 200);
  EXPECT_GT(found.refused, 20);
}

TEST(DamagedFile, TheChecksumOfADatasetIsNamed) {
  const TestFolder folder;
  const std::string file = folder / "s.h5";
  const Snapshot s = small_snapshot();
  write_snapshot(file, "/loaded", s);
  const std::size_t at = find(file, as_bytes(s.grains[7].mass));
  spoil(file, at);
  EXPECT_THAT(refusal_of([&] { read_snapshot(file, "/loaded"); }),
              StartsWith(file + ":/loaded/grains: dataset 'mass': its checksum does not fit: the "
                                "file is damaged"));
  spoil(file, at);
  EXPECT_EQ(read_snapshot(file, "/loaded").grains[7].mass, s.grains[7].mass);
}

TEST(DamagedFile, AHeaderIsRefused) {
  const TestFolder folder;
  const std::string file = folder / "s.h5";
  write_snapshot(file, "/loaded", small_snapshot());
  spoil(file, find(file, "grainfield-snapshot-1"));
  EXPECT_THAT(refusal_of([&] { list_snapshots(file); }),
              HasSubstr("its checksum does not fit: the file is damaged"));
}

// HDF5 takes other data with a checksum of their own, or a chunk that it does not find, for good.
TEST(DamagedFile, OtherDataInTheirPlaceAreNoticed) {
  const TestFolder folder;
  const std::string file = folder / "s.h5";
  hdf5::Handle out = hdf5::open_for_adding(file);
  hdf5::write(out, "values", std::vector<double>{1, 2, 3}, 1, "m");
  hdf5::finish(std::move(out), file);
  {
    const hdf5::Handle again(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const hdf5::Handle set(H5Dopen2(again, "values", H5P_DEFAULT), H5Dclose);
    const std::vector<double> zeros(3, 0);
    ASSERT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data()), 0);
  }
  const hdf5::Handle in = hdf5::open_for_reading(file);
  EXPECT_THAT(refusal_of([&] { hdf5::read_doubles(in, "values", 1, file); }),
              HasSubstr("dataset 'values': its checksum does not fit"));
}

TEST(DamagedFile, TheSameDataGiveTheSameBytes) {
  const TestFolder folder;
  Snapshot s = small_snapshot();
  // More than one chunk, and a last one that is not full.
  const std::vector<double> many(1'000'003, 0.5);
  const auto write = [&](const std::string& file) {
    write_snapshot(file, "/r/one", s);
    write_snapshot(file, "/r/two", s);
    hdf5::Handle out = hdf5::open_for_adding(file);
    hdf5::write(out, "many", many, 1, "m");
    hdf5::finish(std::move(out), file);
  };
  write(folder / "1.h5");
  // HDF5 counts times in seconds.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  write(folder / "2.h5");
  EXPECT_TRUE(bytes_of(folder / "1.h5") == bytes_of(folder / "2.h5"));
  const hdf5::Handle in = hdf5::open_for_reading(folder / "1.h5");
  EXPECT_TRUE(hdf5::read_doubles(in, "many", 1, "1.h5") == many);
  // One that HDF5 1.8 cannot read begins with a newer superblock.
  EXPECT_EQ(bytes_of(folder / "1.h5")[8], 2);
}

TEST(DamagedFile, LinksInCirclesAndDeepOnesEnd) {
  const TestFolder folder;
  const std::string file = folder / "s.h5";
  write_snapshot(file, "/a/b/loaded", small_snapshot());
  write_snapshot(folder / "other.h5", "/far", small_snapshot());
  {
    const hdf5::Handle out = hdf5::open_for_adding(file);
    H5Lcreate_hard(out, "/a", out, "/a/b/again", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_hard(out, "/", out, "/a/root", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/a", out, "/a/b/soft", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/nowhere", out, "/dangling", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external((folder / "other.h5").c_str(), "/", out, "/elsewhere", H5P_DEFAULT,
                       H5P_DEFAULT);
    hid_t deep = H5Gopen2(out, "/", H5P_DEFAULT);
    for (int k = 0; k < 1000; ++k) {
      const hid_t below = H5Gcreate2(deep, "d", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      H5Gclose(deep);
      deep = below;
    }
    H5Gclose(deep);
  }
  EXPECT_THAT(list_snapshots(file), ::testing::ElementsAre("/a/b/loaded"));
  // A soft link may be named; a link into another file leads nowhere.
  EXPECT_EQ(read_snapshot(file, "/a/b/soft/b/loaded").grains.size(), 20U);
  EXPECT_THAT(refusal_of([&] { read_snapshot(file, "/dangling"); }),
              HasSubstr("no snapshot there"));
  EXPECT_NE(refusal_of([&] { read_snapshot(file, "/elsewhere/far"); }), "nothing is refused");
}

TEST(DamagedFile, NamesAreShownShortAndWithoutControlCharacters) {
  const TestFolder folder;
  const std::string file = folder / "s.h5";
  write_snapshot(file, "/plain", small_snapshot());
  {
    const hdf5::Handle out = hdf5::open_for_adding(file);
    H5Lmove(out, "plain", out, "\x1b[2Jclear", H5P_DEFAULT, H5P_DEFAULT);
  }
  write_snapshot(file, "/" + std::string(60000, 'x'), small_snapshot());
  EXPECT_EQ(list_snapshots(file).size(), 2U);
  const std::string said = refusal_of([&] { read_snapshot(file, "/missing"); });
  EXPECT_LT(said.size(), 500U);
  EXPECT_THAT(said, HasSubstr("/?[2Jclear"));
  EXPECT_EQ(said.find('\x1b'), std::string::npos);
}

// An extent that the file cannot hold takes no memory.
TEST(DamagedFile, SizesAreLookedAtBeforeMemoryIsTaken) {
  const TestFolder folder;
  const std::string file = folder / "s.h5";
  {
    const hdf5::Handle out = hdf5::open_for_adding(file);
    const hsize_t shape = hsize_t{1} << 40;
    const hdf5::Handle space(H5Screate_simple(1, &shape, nullptr), H5Sclose);
    const hdf5::Handle set(
        H5Dcreate2(out, "empty", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    const hdf5::Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(text, H5T_VARIABLE);
    const hdf5::Handle words(
        H5Dcreate2(out, "words", text, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    const hdf5::Handle several(H5Screate_simple(1, std::vector<hsize_t>{5}.data(), nullptr),
                               H5Sclose);
    const hdf5::Handle numbers(
        H5Acreate2(out, "five", H5T_NATIVE_DOUBLE, several, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    hdf5::write_attribute(out, "half", 0.5);
    hdf5::write_attribute(out, "word", "w");
  }
  const hdf5::Handle in = hdf5::open_for_reading(file);
  EXPECT_THAT(refusal_of([&] { hdf5::read_doubles(in, "empty", 1, file); }),
              HasSubstr("dataset 'empty' is damaged or foreign: larger than its file"));
  EXPECT_THAT(refusal_of([&] { hdf5::read_doubles(in, "words", 1, file); }),
              HasSubstr("not numbers"));
  EXPECT_THAT(refusal_of([&] { hdf5::read_number_attribute(in, "five"); }),
              HasSubstr("attribute 'five' is not a number"));
  EXPECT_THAT(refusal_of([&] { hdf5::read_integer_attribute(in, "half"); }),
              HasSubstr("attribute 'half' is 0.5; it must be a whole number"));
  EXPECT_THAT(refusal_of([&] { hdf5::read_number_attribute(in, "word"); }),
              StartsWith(file + ":/: attribute 'word' is not a number"));
  EXPECT_THAT(refusal_of([&] { hdf5::read_text_attribute(in, "half"); }),
              HasSubstr("attribute 'half' is not a text"));
}

TEST(DamagedFile, WhatIsNoFileOfDataIsRefused) {
  const TestFolder folder;
  EXPECT_THAT(refusal_of([&] { list_snapshots("/dev/null"); }), HasSubstr("not a regular file"));
  std::ofstream(folder / "empty.h5");
  EXPECT_THAT(refusal_of([&] { list_snapshots(folder / "empty.h5"); }),
              HasSubstr("not an HDF5 file"));
}

TEST(DamagedFile, AChildTellsHowItEnded) {
  const auto end = [](const std::function<bool()>& work) { return run_in_child({1, 1e8}, work); };
  EXPECT_EQ(end([] { return true; }).end, ChildEnd::ok);
  EXPECT_EQ(end([] { return false; }).end, ChildEnd::failed);
  EXPECT_EQ(end([]() -> bool { throw std::bad_alloc(); }).end, ChildEnd::failed);
  EXPECT_EQ(end([]() -> bool { throw std::invalid_argument("no"); }).end, ChildEnd::refused);
  const ChildResult crash = end([] { return std::raise(SIGSEGV) == 0; });
  EXPECT_EQ(crash.end, ChildEnd::crashed);
  EXPECT_EQ(crash.signal, "SIGSEGV");
  const ChildResult abort = end([]() -> bool { std::abort(); });
  EXPECT_EQ(abort.signal, "SIGABRT");
  const ChildResult loop = end([] {
    for (double k = 1; k > 0;) k = std::sqrt(k * k + 1);
    return true;
  });
  EXPECT_EQ(loop.end, ChildEnd::endless);
  // As a system does that has no memory left: it says nothing about the work.
  EXPECT_EQ(end([] { return raise(SIGKILL) == 0; }).end, ChildEnd::killed);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_EQ(end([] { return std::vector<char>(1'000'000'000, 1).back() == 1; }).end,
            ChildEnd::failed);
#endif
  // What it does to signals, limits and memory is its own.
  EXPECT_EQ(end([] { return true; }).end, ChildEnd::ok);
}

// What a thread of the parent takes at the moment of the fork and gives back at once, as malloc
// does for a new arena.
class TakenAtTheFork {
 public:
  TakenAtTheFork() {
    static const int once = pthread_atfork(take, give_back, nullptr);
    EXPECT_EQ(once, 0);
    bytes() = 200'000'000;
  }
  ~TakenAtTheFork() { bytes() = 0; }
  TakenAtTheFork(const TakenAtTheFork&) = delete;
  TakenAtTheFork& operator=(const TakenAtTheFork&) = delete;

 private:
  static std::size_t& bytes() {
    static std::size_t count = 0;
    return count;
  }
  static void*& taken() {
    static void* at = nullptr;
    return at;
  }
  static void take() {
    if (bytes() > 0) {
      taken() = mmap(nullptr, bytes(), PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    }
  }
  static void give_back() {
    if (bytes() > 0) munmap(taken(), bytes());
  }
};

TEST(DamagedFile, AChildHasItsMemoryWhateverItsParentHas) {
  const TakenAtTheFork taken;
  const auto write_some = [] { return std::vector<char>(50'000'000, 1).back() == 1; };
  EXPECT_EQ(run_in_child({1, 1e8}, write_some).end, ChildEnd::ok);
}

}  // namespace
}  // namespace grainfield::dem
