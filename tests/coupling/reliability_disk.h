// A disk that runs full: by a limit on the size of files everywhere, by a small disk of its own
// where root may mount one.
#pragma once
#include <gmock/gmock.h>
#include <sched.h>
#include <sys/mount.h>

#include <cstring>

#include "reliability_interrupts.h"
#include "reliability_scene.h"

namespace grainfield::coupling::testing {

constexpr int kStorage = 74;

/// A tmpfs of a few MB that no other process sees (a mount namespace of the test's own).
class SmallDisk {
 public:
  /// "" or why there cannot be one.
  static std::string why_not() {
    static const std::string reason = [] {
      if (unshare(CLONE_NEWNS) != 0 ||
          mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0)
        return std::string("no mount namespace: ") + std::strerror(errno);
      return std::string();
    }();
    return reason;
  }
  explicit SmallDisk(long bytes) {
    fs::create_directory(path());
    if (mount("grainfield_test", path().c_str(), "tmpfs", 0, size(bytes).c_str()) != 0)
      throw std::runtime_error(std::string("cannot mount: ") + std::strerror(errno));
  }
  ~SmallDisk() { umount2(path().c_str(), MNT_DETACH); }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  std::string path() const { return folder_ / "disk"; }
  void resize(long bytes) const {
    if (mount("grainfield_test", path().c_str(), "tmpfs", MS_REMOUNT, size(bytes).c_str()) != 0)
      throw std::runtime_error(std::string("cannot remount: ") + std::strerror(errno));
  }

 private:
  static std::string size(long bytes) { return "size=" + std::to_string(bytes); }
  Folder folder_;
};

struct DiskTally {
  int tries = 0, refused = 0;
  int resumed = 0;  ///< ended well with room: of runs with the same bits
  void print(const char* what) const {
    std::printf("reliability: %s: %d tries, %d ended in 74, %d ended well with room\n", what, tries,
                refused, resumed);
  }
};

/// What a refusal for want of room says: one line that names what could not be written.
inline void expect_storage(const Ending& ending, const std::string& where) {
  EXPECT_EQ(ending.code, kStorage) << ending;
  ASSERT_FALSE(complaints(ending.err).empty()) << ending;
  EXPECT_THAT(complaints(ending.err).back(), ::testing::HasSubstr(where));
}

/// One run under a limit that `lift` takes away; before it the folder holds `before`.
inline void run_into_a_full_disk(const Reference& study, const std::string& out,
                                 const Contents& before, rlim_t file_size,
                                 const std::function<void()>& lift, DiskTally& tally) {
  Start start{
      {"run", study.file, "-o", out, "--checkpoint-seconds", "0.02", "--threads", "2"}, {}, "", {}};
  start.file_size = file_size;
  ++tally.tries;
  for (int again = 0; again < 2; ++again) {
    const Ending ending = finish(start);
    if (ending.code == 0) {
      EXPECT_EQ(difference(study.whole, results_in(out)), "");
      return;
    }
    tally.refused += again == 0;
    expect_storage(ending, out);
    EXPECT_EQ(complaints(ending.err).size(), 1U) << ending;
    EXPECT_EQ(difference(before, results_in(out)), "");
    EXPECT_EQ(leftovers(out), "");
    // Without room it is not resumed either, and still nothing is lost.
    if (holds_work(out) && again == 0) start.words.emplace_back("--resume");
  }
  lift();
  start.file_size = RLIM_INFINITY;
  std::erase(start.words, "--resume");
  if (holds_work(out)) start.words.emplace_back("--resume");
  const Ending ending = finish(start);
  EXPECT_EQ(ending.code, 0) << "with room: " << ending;
  const std::string wrong = difference(study.whole, results_in(out));
  EXPECT_EQ(wrong, "") << "with room";
  EXPECT_EQ(leftovers(out), "");
  tally.resumed += wrong.empty();
}

/// `ulimit -f`: strikes checkpoints, realizations, fields, report or summary, by its size.
inline void limit_files(const std::string& study, const std::vector<rlim_t>& sizes,
                        bool over_earlier, DiskTally& tally) {
  for (const rlim_t size : sizes) {
    SCOPED_TRACE(study + ", files of at most " + std::to_string(size) + " bytes");
    const Folder folder;
    const Reference& made = reference(study);
    if (over_earlier) fs::copy(made.earlier_folder(), folder / "out", fs::copy_options::recursive);
    run_into_a_full_disk(
        made, folder / "out", over_earlier ? made.earlier : Contents{}, size, [] {}, tally);
  }
}

/// A disk of so many bytes beside what an earlier run takes.
inline void fill_disk(const std::string& study, const std::vector<long>& rooms, bool over_earlier,
                      DiskTally& tally) {
  constexpr long kLarge = 64L << 20;
  for (const long room : rooms) {
    SCOPED_TRACE(study + ", a disk with " + std::to_string(room) + " bytes");
    const SmallDisk disk(kLarge);
    const Reference& made = reference(study);
    const std::string out = disk.path() + "/out";
    long taken = 0;
    if (over_earlier) {
      fs::copy(made.earlier_folder(), out, fs::copy_options::recursive);
      const fs::space_info space = fs::space(disk.path());
      taken = static_cast<long>(space.capacity - space.available);
    }
    disk.resize(taken + room);
    run_into_a_full_disk(
        made, out, over_earlier ? made.earlier : Contents{}, RLIM_INFINITY,
        [&] { disk.resize(kLarge); }, tally);
  }
}

/// Commands that write: the earlier output stays, nothing lies beside it, and with room it works.
inline void limit_commands(const std::vector<rlim_t>& sizes, DiskTally& tally) {
  for (const Command& command : workshop().writing()) {
    for (const rlim_t size : sizes) {
      SCOPED_TRACE(command.name + ", files of at most " + std::to_string(size) + " bytes");
      const Folder folder;
      const std::string name = "out" + command.ending(), output = folder / name;
      if (command.writes == Writes::folder) fs::create_directory(output);
      folder.write(command.writes == Writes::folder ? name + "/notes" : name, "old");
      const Contents before = made_by(command, output);
      Start start = command.to(output);
      start.file_size = size;
      const Ending ending = finish(start);
      ++tally.tries;
      EXPECT_EQ(leftovers(folder.path()), "");
      if (ending.code == 0) continue;
      ++tally.refused;
      expect_storage(ending, folder.path());
      // Whole or not at all: no file of the new result beside the old ones.
      EXPECT_EQ(difference(before, made_by(command, output)), "");
      start.file_size = RLIM_INFINITY;
      if (holds_work(output)) start.words.emplace_back("--resume");
      const bool well = finish(start).code == 0;
      EXPECT_TRUE(well);
      tally.resumed += well;
    }
  }
}

}  // namespace grainfield::coupling::testing
