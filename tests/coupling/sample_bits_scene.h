// The bits that a run leaves, whatever the number of threads and after kills.
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "coupling/result/tables.h"
#include "reliability_process.h"
#include "tests/all_cores.h"

namespace grainfield::coupling::testing {

/// What a run leaves, without pictures.
inline constexpr const char* kBare = " --set output.report=false --set output.vtu=false ";

/// Runs the case on one thread; and again on two until it is killed, on one until it is killed, on
/// three to its end: the files are the same. It is killed at checkpoints that hold the text
/// `inside`, such as the name of a recorded state. `look` sees the summary of the first.
inline void expect_same_bits(const std::string& text, const std::string& inside = "",
                             const std::function<void(const Summary&)>& look = {}) {
  const Folder folder;
  const std::string file = folder.write("x.toml", text);
  const Output output = program("run " + file + " -o " + (folder / "one") + kBare + "--threads 1");
  ASSERT_EQ(output.code, 0) << output.err;
  if (look) look(read_summary(folder / "one/summary.json"));
  const grainfield::test::AllCores cores;
  const std::string out = folder / "killed";
  const auto on_threads = [&](const char* threads, bool saves_often) {
    Start start;
    start.words = {"run",       file,
                   "-o",        out,
                   "--threads", threads,
                   "--set",     "output.report=false",
                   "--set",     "output.vtu=false"};
    if (fs::exists(out)) start.words.emplace_back("--resume");
    start.words.emplace_back("--checkpoint-seconds");
    start.words.emplace_back(saves_often ? "0" : "30");
    return start;
  };
  int kills = 0;
  const std::string checkpoint = out + "/checkpoint/realization_000.h5.checkpoint";
  for (const char* threads : {"2", "1"}) {
    std::error_code none;
    auto seen = fs::last_write_time(checkpoint, none);
    Child child(on_threads(threads, true));
    child.wait_until([&] {
      std::error_code error;
      const auto now = fs::last_write_time(checkpoint, error);
      if (error || now == seen) return false;
      seen = now;
      return inside.empty() || read_text(checkpoint).find(inside) != std::string::npos;
    });
    child.send(SIGKILL);
    const Ending ending = child.wait();
    ASSERT_TRUE(ending.signal == SIGKILL || ending.code == 0) << ending;
    kills += ending.signal == SIGKILL;
    if (ending.code == 0) break;
  }
  EXPECT_GT(kills, 0);
  if (fs::exists(out + "/checkpoint")) {
    const Ending ending = finish(on_threads("3", false));
    ASSERT_EQ(ending.code, 0) << ending;
  }
  EXPECT_EQ(contents(out), contents(folder / "one")) << "after " << kills << " kills";
}

}  // namespace grainfield::coupling::testing
