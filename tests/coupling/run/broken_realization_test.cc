// Checkpoints and finished realizations that are empty, cut or damaged: the realization starts
// again and ends in the same bits.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "coupling/base/signals.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/realization_file.h"
#include "coupling/studies/point_load/simulation.h"
#include "dem/cannot_read_now.h"
#include "dem/storage_failed.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using testing::Output;
using testing::program;
using testing::read_text;
using ::testing::StartsWith;
using testing::tiny_case;

dem::PointLoadSetup small() {
  dem::PointLoadSetup s;
  s.packing.kind = "triangular";
  s.packing.sizes = "mono";
  s.packing.columns = 7;
  s.packing.rows = 3;
  s.load.force = 1;
  s.load.ramp_time = 0.01;
  s.rest.background_damping = 300;
  s.rest.unbalanced_force_ratio = 1e-4;
  s.rest.kinetic_to_elastic_energy = 1e-7;
  return s;
}

struct Ensemble {
  std::vector<Task> tasks;
  std::vector<std::string> notes;

  Ensemble(const Folder& folder, int count, std::uint64_t seed = 3) {
    for (int k = 0; k < count; ++k) {
      tasks.push_back(
          {[=](int threads) { return dem::make_point_load_run(small(), seed + k, threads); },
           folder / ("r" + std::to_string(k) + ".h5")});
    }
  }
  void run(long stop_after_steps = 0) {
    EnsembleOptions options;
    options.stop_after_steps = stop_after_steps;
    options.note = [&](const std::string& text) { notes.push_back(text); };
    run_tasks(tasks, Ranks(), options);
  }
};

// What may become of a file, and how.
std::vector<std::pair<std::string, std::string>> spoilt(const std::string& whole) {
  std::string head = whole;
  head[60] ^= 4;
  return {{"empty", ""},
          {"cut", whole.substr(0, whole.size() / 3)},
          {"zeros", std::string(whole.size(), '\0')},
          {"a wrong byte in its head", head}};
}

void put(const std::string& file, const std::string& bytes) {
  std::ofstream(file + ".new", std::ios::binary) << bytes;
  testing::fs::rename(file + ".new", file);
}

TEST(BrokenRealization, ACheckpointIsNoDeadEnd) {
  const Folder folder, whole_folder;
  Ensemble whole(whole_folder, 1);
  whole.run();
  EXPECT_TRUE(whole.notes.empty());
  Ensemble stopped(folder, 1);
  const std::string file = folder / "r0.h5", checkpoint = file + ".checkpoint";
  EXPECT_THROW(stopped.run(500), Interrupted);
  const std::string good = read_text(checkpoint);
  for (const auto& [how, bytes] : spoilt(good)) {
    put(checkpoint, bytes);
    stopped.notes.clear();
    stopped.run();
    EXPECT_THAT(
        stopped.notes,
        ElementsAre(MatchesRegex(checkpoint + " is broken \\(.+\\): this realization starts "
                                              "again")))
        << how;
    EXPECT_TRUE(read_text(file) == read_text(whole_folder / "r0.h5")) << how;
    EXPECT_FALSE(testing::fs::exists(checkpoint)) << how;
    testing::fs::remove(file);
  }
  // A good one is gone on from.
  put(checkpoint, good);
  stopped.notes.clear();
  stopped.run();
  EXPECT_TRUE(stopped.notes.empty());
  EXPECT_TRUE(read_text(file) == read_text(whole_folder / "r0.h5"));
}

TEST(BrokenRealization, AFinishedOneIsDoneAgain) {
  const Folder folder;
  Ensemble ensemble(folder, 2);
  ensemble.run();
  const std::string file = folder / "r1.h5", good = read_text(file);
  for (const auto& [how, bytes] : spoilt(good)) {
    put(file, bytes);
    ensemble.notes.clear();
    ensemble.run();
    EXPECT_THAT(ensemble.notes,
                ElementsAre(MatchesRegex(file + " is broken \\(.+\\): this realization starts "
                                                "again")))
        << how;
    EXPECT_TRUE(read_text(file) == good) << how;
  }
}

TEST(BrokenRealization, ACheckpointOfAnotherSeedIsAMistake) {
  const Folder folder;
  Ensemble stopped(folder, 1), other(folder, 1, 4);
  EXPECT_THROW(stopped.run(500), Interrupted);
  EXPECT_THROW(other.run(), std::invalid_argument);
  EXPECT_TRUE(other.notes.empty());
}

// A disk that fills up while a checkpoint is written leaves the one before.
TEST(BrokenRealization, AFullDiskLeavesTheLastCheckpoint) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "HDF5 keeps what it could not write, which counts as leaks";
#endif
  const Folder folder;
  Ensemble stopped(folder, 1);
  const std::string checkpoint = folder / "r0.h5.checkpoint";
  EXPECT_THROW(stopped.run(500), Interrupted);
  const std::string before = read_text(checkpoint);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  rlimit limit = old;
  limit.rlim_cur = before.size() / 2;
  setrlimit(RLIMIT_FSIZE, &limit);
  std::string said = "nothing";
  try {
    stopped.run(600);
  } catch (const dem::StorageFailed& e) {
    said = e.what();
  } catch (const Interrupted&) {
  }
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(said, HasSubstr("is the disk full?"));
  EXPECT_TRUE(read_text(checkpoint) == before);
  EXPECT_FALSE(testing::fs::exists(checkpoint + ".part"));
}

// While it lives, this process can open no more files.
class NoMoreFiles {
 public:
  NoMoreFiles() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const int next = dup(0);
    close(next);
    rlimit during = before_;
    during.rlim_cur = static_cast<rlim_t>(next);
    setrlimit(RLIMIT_NOFILE, &during);
  }
  ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

std::string unreadable(Ensemble& ensemble) {
  const NoMoreFiles none;
  try {
    ensemble.run();
  } catch (const dem::CannotReadNow& e) {
    return e.what();
  }
  return "nothing";
}

// What cannot be read at this moment is not broken.
TEST(BrokenRealization, OneThatCannotBeReadNowIsKept) {
  const Folder folder;
  Ensemble done(folder, 2);
  done.run();
  const std::string file = folder / "r0.h5", good = read_text(file);
  EXPECT_THAT(unreadable(done),
              AllOf(StartsWith(file + ": cannot be read now: Too many open files"),
                    HasSubstr("it is kept as it is: continue with --resume")));
  EXPECT_TRUE(done.notes.empty());
  EXPECT_TRUE(read_text(file) == good);

  Ensemble stopped(folder, 3);
  EXPECT_THROW(stopped.run(500), Interrupted);
  for (const char* whole : {"r0.h5", "r1.h5"}) testing::fs::remove(folder / whole);
  stopped.tasks.erase(stopped.tasks.begin(), stopped.tasks.begin() + 2);
  const std::string checkpoint = folder / "r2.h5.checkpoint", half = read_text(checkpoint);
  EXPECT_THAT(unreadable(stopped), StartsWith(checkpoint + ": cannot be read now: "));
  EXPECT_TRUE(read_text(checkpoint) == half);
  stopped.run();
  EXPECT_TRUE(stopped.notes.empty());
}

TEST(BrokenRealization, ProgressCountsWhatWasDoneBefore) {
  const Folder folder;
  Ensemble ensemble(folder, 3);
  ensemble.run();
  testing::fs::remove(folder / "r1.h5");
  EnsembleOptions options;
  std::vector<EnsembleProgress> told;
  options.progress = [&](const EnsembleProgress& p) { told.push_back(p); };
  run_tasks(ensemble.tasks, Ranks(), options);
  ASSERT_FALSE(told.empty());
  for (const EnsembleProgress& p : told) {
    EXPECT_EQ(p.total, 3);
    EXPECT_GE(p.done, 2);
    EXPECT_GE(p.fraction, 2. / 3 - 1e-12);
    EXPECT_LE(p.fraction, 1 + 1e-12);
  }
  EXPECT_EQ(told.back().done, 3);
}

TEST(BrokenRealization, TheProgramSaysItAndGoesOn) {
  const Folder folder;
  const std::string file = folder.write("x.toml", tiny_case());
  ASSERT_EQ(program("run " + file + " -o " + (folder / "whole")).code, 0);
  const std::string out = folder / "out", run = "run " + file + " --threads 2 -o " + out;
  ASSERT_EQ(program(run + " --stop-after-steps 500").code, 130);
  const std::string checkpoint = out + "/checkpoint/realization_000.h5.checkpoint";
  testing::fs::resize_file(checkpoint, 0);
  const Output output = program(run + " --resume");
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.err,
              HasSubstr(checkpoint + " is broken (not an HDF5 file, or its beginning is "
                                     "broken): this realization starts again"));
  EXPECT_TRUE(testing::contents(folder / "whole") == testing::contents(out));
}

}  // namespace
}  // namespace grainfield::coupling
