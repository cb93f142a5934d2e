// The bits that a run leaves, whatever the number of threads and after kills.
#pragma once
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "reliability_process.h"

namespace grainfield::coupling::testing {

/// What a run leaves, without pictures.
inline constexpr const char* kBare = " --set output.report=false --set output.vtu=false ";

/// Runs the case on 1, 2 and 3 threads, and kills it twice and resumes it: the files are the same.
/// It is killed at a checkpoint that holds the text `inside`, such as the name of a recorded state.
inline void expect_same_bits(const std::string& text, const std::string& inside = "") {
  const Folder folder;
  const std::string file = folder.write("x.toml", text);
  std::map<std::string, std::string> one;
  for (const char* threads : {"1", "2", "3"}) {
    const std::string out = folder / threads;
    const Output output = program("run " + file + " -o " + out + kBare + "--threads " + threads);
    ASSERT_EQ(output.code, 0) << output.err;
    if (one.empty()) one = contents(out);
    EXPECT_EQ(contents(out), one) << threads << " threads";
  }
  const std::string out = folder / "killed";
  std::vector<std::string> words{"run",
                                 file,
                                 "-o",
                                 out,
                                 "--threads",
                                 "1",
                                 "--checkpoint-seconds",
                                 "0",
                                 "--set",
                                 "output.report=false",
                                 "--set",
                                 "output.vtu=false"};
  int kills = 0;
  Ending ending;
  for (int start = 0; start < 3; ++start) {
    Start begin;
    begin.words = words;
    Child child(begin);
    const std::string checkpoint = out + "/checkpoint/realization_000.h5.checkpoint";
    const auto before =
        fs::exists(checkpoint) ? fs::last_write_time(checkpoint) : fs::file_time_type::min();
    child.wait_until([&] {
      std::error_code error;
      const auto now = fs::last_write_time(checkpoint, error);
      if (error || !(now > before) || start == 2) return false;
      return inside.empty() || read_text(checkpoint).find(inside) != std::string::npos;
    });
    child.send(SIGKILL);
    ending = child.wait();
    kills += ending.signal == SIGKILL;
    if (start == 0) words.emplace_back("--resume");
    if (ending.signal == 0) break;
  }
  EXPECT_GT(kills, 0);
  if (ending.signal != 0) {
    Start again;
    again.words = words;
    ending = finish(again);
  }
  ASSERT_EQ(ending.code, 0) << ending;
  EXPECT_EQ(contents(out), one) << "after " << kills << " kills";
}

}  // namespace grainfield::coupling::testing
