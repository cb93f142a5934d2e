// docs/steps.md: every command in it runs, in order, on files as it describes them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "continuum/closed/osl.h"
#include "coupling/output/tables.h"
#include "import_scene.h"
#include "program.h"
#include "stressed_heap.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using testing::Output;
using testing::program;

const std::string kDocs = std::string(GRAINFIELD_CASES) + "/../docs/";

void write_heaps(const Folder& folder) {
  const auto field =
      continuum::osl_field(28 * std::numbers::pi / 180, {0.74, -0.31}, test::lattice_rho_g());
  for (int k = 1; k <= 4; ++k) {
    test::StressedHeap setup;
    setup.floor = 0.3;
    setup.apex_x = 1.7;
    setup.noise = 0.2;
    setup.seed = static_cast<std::uint64_t>(k);
    const dem::Snapshot heap =
        test::stressed_heap(setup, [&](double x, double y) { return field.stress(x, y); });
    folder.write("grains" + std::to_string(k) + ".csv", test::csv_grains(heap));
    folder.write("contacts" + std::to_string(k) + ".csv", test::csv_contacts(heap));
    folder.write("walls.csv", test::csv_walls(heap));
  }
}

TEST(Steps, EveryCommandRuns) {
  const Folder folder;
  write_heaps(folder);
  folder.write("points.csv", "x,y\n0,-0.025\n0.01,-0.05\n");
  std::istringstream page(testing::read_text(kDocs + "steps.md"));
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
    const Output out = program(line.substr(start.size()), "cd " + folder.path() + " &&");
    EXPECT_EQ(out.code, 0) << line << "\n" << out.err;
  }
  EXPECT_GE(commands, 20);
  const Summary fit = read_summary(folder / "fit/summary.json");
  EXPECT_NEAR(std::get<double>(fit.at("fit.osl.eta")), 0.74, 0.03);
  EXPECT_NEAR(std::get<double>(fit.at("fit.osl.mu")), -0.31, 0.06);
}

}  // namespace
}  // namespace grainfield::coupling
