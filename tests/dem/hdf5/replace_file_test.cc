// What is on the disk when a file takes its place. This suite's own fsync() tells what was asked
// for, and fails when told to.
#include "dem/hdf5/replace_file.h"

#include <gmock/gmock.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

#include "dem/storage_failed.h"
#include "tests/damaged_files.h"

namespace {

std::vector<std::string> flushed;
int fail_with = 0;

}  // namespace

extern "C" int fsync(int file) {
  flushed.push_back(
      std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(file)).string());
  if (fail_with != 0) {
    errno = fail_with;
    return -1;
  }
  return static_cast<int>(syscall(SYS_fsync, file));
}

namespace grainfield::dem {
namespace {

using grainfield::testing::bytes_of;
using grainfield::testing::TestFolder;
using ::testing::HasSubstr;

void put(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

TEST(ReplaceFile, BytesThenNameAreOnTheDisk) {
  const TestFolder folder;
  put(folder / "x.part", "new");
  put(folder / "x", "old");
  flushed.clear();
  replace_file(folder / "x.part", folder / "x");
  EXPECT_EQ(bytes_of(folder / "x"), "new");
  EXPECT_FALSE(std::filesystem::exists(folder / "x.part"));
  const std::string folder_itself = std::filesystem::path(folder / "x").parent_path().string();
  EXPECT_THAT(flushed, ::testing::ElementsAre(folder / "x.part", folder_itself));
}

TEST(ReplaceFile, ADiskThatFailsIsSaidBeforeTheOldFileGoes) {
  const TestFolder folder;
  put(folder / "x", "old");
  for (const int error : {EIO, ENOSPC, EDQUOT, EFBIG}) {
    fail_with = error;
    try {
      write_in_place_of(folder / "x", [](const std::string& beside) { put(beside, "new"); });
      ADD_FAILURE() << "nothing is said of " << error;
    } catch (const StorageFailed& e) {
      EXPECT_THAT(e.what(), HasSubstr((folder / "x") + ": cannot be written to its end"));
    }
    EXPECT_EQ(bytes_of(folder / "x"), "old");
    EXPECT_FALSE(std::filesystem::exists(folder / "x.part"));
  }
  fail_with = EINVAL;  // a file system that cannot tell
  write_in_place_of(folder / "x", [](const std::string& beside) { put(beside, "new"); });
  EXPECT_EQ(bytes_of(folder / "x"), "new");
  fail_with = 0;
}

TEST(ReplaceFile, NamesOfWhatIsBeingWritten) {
  EXPECT_EQ(final_name("a/b.h5"), "a/b.h5");
  EXPECT_EQ(final_name("a/b.h5.part"), "a/b.h5");
  EXPECT_EQ(final_name("a/.b.h5.0123456789abcdef.part"), "a/b.h5");
  EXPECT_EQ(final_name("out/.partial/inner/..results.0123456789abcdef.part"), "out/inner/.results");
  EXPECT_EQ(final_name("out/.partial/report.html"), "out/report.html");
  EXPECT_EQ(final_name(".part"), "");
}

TEST(ReplaceFile, WhatIsNotWrittenDoesNotTakeItsPlace) {
  const TestFolder folder;
  put(folder / "x", "old");
  put(folder / "x.part", "of a run that was killed");
  EXPECT_THROW(write_in_place_of(folder / "x",
                                 [](const std::string& beside) {
                                   EXPECT_FALSE(std::filesystem::exists(beside));
                                   put(beside, "half");
                                   throw std::invalid_argument("stopped");
                                 }),
               std::invalid_argument);
  EXPECT_EQ(bytes_of(folder / "x"), "old");
  EXPECT_FALSE(std::filesystem::exists(folder / "x.part"));
  EXPECT_THROW(replace_file(folder / "missing", folder / "x"), StorageFailed);
}

}  // namespace
}  // namespace grainfield::dem
