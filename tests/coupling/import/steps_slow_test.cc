// docs/steps.md: every command in it runs, in order, on files as it describes them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "coupling/result/tables.h"
#include "tests/coupling/guide_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using testing::Output;
using testing::program;

TEST(Steps, EveryCommandRuns) {
  const Folder folder;
  test::write_heaps(folder, 4);
  folder.write("points.csv", "x,y\n0,-0.025\n0.01,-0.05\n");
  std::istringstream page(testing::read_text(test::kDocs + "steps.md"));
  std::string line, block;
  bool toml = false;
  int commands = 0;
  while (std::getline(page, line)) {
    if (line == "```toml") {
      toml = true;
      block.clear();
    } else if (line == "```" && toml) {
      toml = false;
      folder.write("layer.toml", block);
    } else if (toml) {
      block += line + "\n";
    }
    const std::string start = "    grainfield ";
    if (line.compare(0, start.size(), start) != 0) continue;
    ++commands;
    std::string words = line.substr(start.size());
    // Ten draws of each fit's bootstrap: guide_slow_test.cc runs fits with all of them.
    if (words.starts_with("fit ")) words += " --set fit.bootstrap=10";
    const Output out = program(words, "cd " + folder.path() + " &&");
    EXPECT_EQ(out.code, 0) << line << "\n" << out.err;
  }
  EXPECT_GE(commands, 20);
  const Summary fit = read_summary(folder / "fit/summary.json");
  EXPECT_NEAR(std::get<double>(fit.at("fit.osl.eta")), 0.74, 0.03);
  EXPECT_NEAR(std::get<double>(fit.at("fit.osl.mu")), -0.31, 0.06);
}

}  // namespace
}  // namespace grainfield::coupling
