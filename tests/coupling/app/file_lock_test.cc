// The lock of a folder where the file system knows no locks, and what is said while its holder has
// not yet written its name.
#include "coupling/base/file_lock.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <memory>

#include "tests/coupling/program.h"

namespace {
bool without_locks = false;
}

// Stands for the C library's.
extern "C" int flock(int descriptor, int operation) noexcept {
  if (!without_locks) return static_cast<int>(syscall(SYS_flock, descriptor, operation));
  errno = ENOLCK;
  return -1;
}

namespace grainfield::coupling {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class FileLockTest : public ::testing::Test {
 protected:
  ~FileLockTest() override { without_locks = false; }
  std::string file() const { return folder_ / ".lock"; }
  std::string take() {
    try {
      const FileLock lock(file(), "out", "wait for it", "grainfield run");
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  }
  testing::Folder folder_;
};

TEST_F(FileLockTest, TheWordOfAnotherHostNamesTheFileToRemove) {
  without_locks = true;
  folder_.write(".lock", "123 elsewhere grainfield run x.toml\n");
  EXPECT_THAT(take(), AllOf(HasSubstr("out: in use by process 123 on elsewhere (grainfield run "),
                            HasSubstr("if nobody works there, remove " + file())));
  testing::fs::remove(file());
  EXPECT_EQ(take(), "");
}

TEST_F(FileLockTest, WhereThereAreLocksNobodyIsToldToRemoveAnything) {
  const FileLock first(file(), "out", "wait for it", "grainfield fit");
  EXPECT_THAT(take(), AllOf(HasSubstr("in use by process " + std::to_string(getpid())),
                            Not(HasSubstr("remove"))));
}

TEST_F(FileLockTest, APipeIsNoLock) {
  ASSERT_EQ(mkfifo(file().c_str(), 0600), 0);
  EXPECT_EQ(take(), "out: " + file() +
                        " is a pipe or a device, expected a file of grainfield's; remove it");
  EXPECT_TRUE(testing::fs::exists(file()));
}

// Taken, but not signed yet.
TEST_F(FileLockTest, AHolderWithoutANameIsAnother) {
  const std::string name = folder_.write(".lock", "");
  const int held = open(name.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(flock(held, LOCK_EX | LOCK_NB), 0);
  EXPECT_THAT(take(), HasSubstr("in use by another process, which has not yet said its name"));
  close(held);
}

}  // namespace
}  // namespace grainfield::coupling
