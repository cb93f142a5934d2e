// The same case and seed give the same bits on any number of threads and ranks, and after being
// stopped anywhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "coupling/run/ensemble.h"
#include "tests/all_cores.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;
using testing::tiny_case;

// MPI keeps memory of its own until the end: the leak check of sanitized builds is for one process.
const std::string kMpirun =
    "ASAN_OPTIONS=detect_leaks=0 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
    "timeout 120 mpirun --oversubscribe ";

std::map<std::string, std::string> results_of(const Folder& folder, const std::string& name,
                                              const std::string& options,
                                              const std::string& prefix = "") {
  const std::string file = folder.write("x.toml", tiny_case());
  const Output output = program("run " + file + " -o " + (folder / name) + " " + options, prefix);
  EXPECT_EQ(output.code, 0) << output.err;
  return testing::contents(folder / name);
}

void expect_same(const std::map<std::string, std::string>& a,
                 const std::map<std::string, std::string>& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (const auto& [name, text] : a) {
    ASSERT_EQ(b.count(name), 1U) << what << ": " << name;
    EXPECT_TRUE(b.at(name) == text) << what << ": " << name << " differs";
  }
}

TEST(Determinism, ThreadsAndRanks) {
  const grainfield::test::AllCores cores;
  const Folder folder;
  const auto one = results_of(folder, "one", "--threads 1");
  EXPECT_GT(one.size(), 10U);
  for (const char* threads : {"2", "4"}) {
    expect_same(one,
                results_of(folder, std::string("t") + threads, std::string("--threads ") + threads),
                std::string(threads) + " threads");
  }
  expect_same(one, results_of(folder, "ranks", "", kMpirun + "-np 2"), "2 ranks");
}

// The second rank counts on a realization that the first does not make, and fails alone, in the
// analysis: the first must not wait for it for ever.
TEST(Ranks, OneThatFailsAloneEndsAll) {
  const Folder folder;
  const std::string run = "run " + folder.write("x.toml", tiny_case()) + " -o " + (folder / "out");
  const Output output =
      program(run + " : -np 1 " + GRAINFIELD_PROGRAM + " " + run + " --set ensemble.realizations=5",
              kMpirun + "-np 1");
  EXPECT_NE(output.code, 0);
  EXPECT_NE(output.code, 124) << "still waiting";
  EXPECT_THAT(output.err, HasSubstr("realization_004.h5: no such file"));
  EXPECT_FALSE(testing::fs::exists(folder / "out/summary.json"));
}

TEST(Determinism, AnotherSeedGivesOtherBits) {
  const Folder folder;
  const auto a = results_of(folder, "a", "");
  const auto b = results_of(folder, "b", "--set ensemble.seed=2");
  EXPECT_NE(a.at("profiles.csv"), b.at("profiles.csv"));
}

TEST(Determinism, StoppedAnywhereAndResumed) {
  const Folder folder;
  const auto whole = results_of(folder, "whole", "--threads 2");
  const std::string file = folder / "x.toml";
  std::mt19937 random(std::random_device{}());
  for (int round = 0; round < 2; ++round) {
    const std::string out = folder / ("stopped" + std::to_string(round));
    int stops = 0;
    long at = 0;
    Output output;
    do {
      at += 1 + static_cast<long>(random() % 8000);
      output = program("run " + file + " -o " + out + " --threads 2 " +
                       (stops > 0 ? "--resume" : "") + " --stop-after-steps " + std::to_string(at));
      if (output.code != 130) break;
      ++stops;
      EXPECT_THAT(output.err, HasSubstr("--resume"));
      EXPECT_TRUE(testing::fs::exists(out + "/checkpoint"));
      EXPECT_FALSE(testing::fs::exists(out + "/summary.json"));
      EXPECT_FALSE(testing::fs::exists(out + "/.partial"));
    } while (stops < 100);
    ASSERT_EQ(output.code, 0) << output.err;
    EXPECT_GT(stops, 0) << "first stop at " << at;
    EXPECT_FALSE(testing::fs::exists(out + "/checkpoint"));
    expect_same(whole, testing::contents(out),
                "stopped " + std::to_string(stops) + " times, last at " + std::to_string(at));
  }
}

TEST(Determinism, SignalsStopAndLeaveWhatResumeNeeds) {
  for (const char* signal : {"INT", "TERM"}) {
    const Folder folder;
    const std::string file = folder.write("x.toml", tiny_case());
    const std::string out = folder / "out";
    // Sent once the run is at work, which lasts long enough to be found there.
    const std::string script = folder.write(
        "stop.sh", "\"$@\" &\npid=$!\nwhile [ ! -e " + out +
                       "/checkpoint/case.toml ]; do sleep 0.02; done\nsleep 0.1\nkill -" + signal +
                       " $pid\nwait $pid\n");
    const Output output =
        program("run " + file + " -o " + out +
                    " --set packing.columns=40 --set packing.rows=16 --set load.ramp_time=20",
                "sh " + script);
    EXPECT_EQ(output.code, 130) << output.err;
    EXPECT_THAT(output.err, HasSubstr("stopped; "));
    EXPECT_TRUE(testing::fs::exists(out + "/checkpoint/realization_000.h5.checkpoint"));
    EXPECT_FALSE(testing::fs::exists(out + "/.partial"));
  }
}

TEST(Resume, RefusesAnotherCaseAndSaysWhatDiffers) {
  const Folder folder;
  const std::string file = folder.write("x.toml", tiny_case());
  const std::string run = "run " + file + " -o " + (folder / "out");
  ASSERT_EQ(program(run + " --stop-after-steps 50").code, 130);
  const Output other = program(run + " --resume --set material.friction=0.25");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err,
              HasSubstr("is of another case: material.friction = 0.5 there, material.friction = "
                        "0.25 here"));
  const Output forgotten = program(run);
  EXPECT_EQ(forgotten.code, 2);
  EXPECT_THAT(forgotten.err, HasSubstr("holds an unfinished run; continue it with --resume"));
  EXPECT_EQ(program(run + " --resume").code, 0);
  const Output finished = program(run + " --resume");
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr("is finished; leave --resume out to run anew"));
}

TEST(Resume, RepeatsAFailedAnalysisWithoutTheGrains) {
  const Folder folder;
  const auto whole = results_of(folder, "whole", "--threads 2");
  const std::string run =
      "run " + (folder / "x.toml") + " --threads 2 -o " + (folder / "out") + " ";
  // No grain has its centre in so narrow a kernel.
  const Output failed = program(run + "--set average.width=1e-6");
  EXPECT_EQ(failed.code, 2);
  EXPECT_THAT(failed.err, HasSubstr("no point has enough grains around it; "));
  EXPECT_THAT(failed.err, HasSubstr("; the grains are kept in " + (folder / "out/checkpoint") +
                                    ": --resume repeats"));
  EXPECT_FALSE(testing::fs::exists(folder / "out/summary.json"));
  const auto made = testing::fs::last_write_time(folder / "out/checkpoint/realization_001.h5");
  // Still wrong: the same grains are kept again.
  EXPECT_EQ(program(run + "--resume --set average.width=1e-6").code, 2);
  EXPECT_EQ(testing::fs::last_write_time(folder / "out/checkpoint/realization_001.h5"), made);
  const Output done = program(run + "--resume");
  EXPECT_EQ(done.code, 0) << done.err;
  expect_same(whole, testing::contents(folder / "out"), "analysis repeated");
  EXPECT_FALSE(testing::fs::exists(folder / "out/checkpoint"));
}

// All of them, cut; broken_realization_test.cc spoils them in other ways.
TEST(Resume, CutCheckpointsStartAgainToTheSameBits) {
  const Folder folder;
  const auto whole = results_of(folder, "whole", "--threads 2");
  const std::string run = "run " + (folder / "x.toml") + " -o " + (folder / "out") + " --threads 2";
  ASSERT_EQ(program(run + " --stop-after-steps 50").code, 130);
  int cut = 0;
  for (const auto& entry : testing::fs::directory_iterator(folder / "out/checkpoint")) {
    if (entry.path().extension() == ".checkpoint") {
      testing::fs::resize_file(entry.path(), testing::fs::file_size(entry.path()) / 2);
      ++cut;
    }
  }
  const Output output = program(run + " --resume");
  EXPECT_EQ(output.code, 0) << output.err;
  for (int r = 0; r < cut; ++r) {
    EXPECT_THAT(output.err,
                HasSubstr("realization_00" + std::to_string(r) +
                          ".h5.checkpoint is broken (the HDF5 file is truncated or broken"));
  }
  EXPECT_GT(cut, 0);
  expect_same(whole, testing::contents(folder / "out"), "started again");
}

TEST(Seeds, AreSplitMix64) {
  // First outputs of the reference implementation (Vigna, splitmix64.c) from state 0.
  EXPECT_EQ(realization_seed(0, 0), 0xE220A8397B1DCDAFULL);
  EXPECT_EQ(realization_seed(0, 1), 0x6E789E6AA1B965F4ULL);
  EXPECT_EQ(realization_seed(0, 2), 0x06C45D188009454FULL);
}

}  // namespace
}  // namespace grainfield::coupling
