// Hard disks that turn soft through the real program: at rest, pictures, the same bits, refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "coupling/studies/hard_to_soft/simulation.h"
#include "dem/snapshot/snapshot.h"
#include "tests/coupling/check_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

constexpr const char* kRain = R"(title = "rain"
study = "hard-to-soft"
[switch]
columns = 5
rows = 4
[ensemble]
realizations = 2
)";

double number(const Summary& summary, const std::string& key) {
  const auto at = summary.find(key);
  if (at == summary.end()) {
    ADD_FAILURE() << "no " << key;
    return 0;
  }
  return std::get<double>(at->second);
}

TEST(HardToSoftRun, RestsSoftAndClosesItsBalance) {
  const Folder folder;
  const std::string file = folder.write("x.toml", kRain);
  const Output out = program("run " + file + " -o " + (folder / "out"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(s));
  EXPECT_EQ(number(s, "dem.grains"), 20);
  EXPECT_EQ(number(s, "switch.at_rest"), 1);
  EXPECT_GT(number(s, "switch.soft_share"), 0.85);
  EXPECT_NEAR(number(s, "base.weight_ratio"), 1, 0.03);
  EXPECT_GT(number(s, "switch.collisions"), 20);
  EXPECT_GT(number(s, "switch.lost_impulses"), number(s, "switch.switched"));
  EXPECT_LT(number(s, "switch.balance_error"), 1e-7);
  EXPECT_THAT(testing::read_text(folder / "out/history.csv"), HasSubstr("time,soft,kinetic"));
  const std::string page = testing::read_text(folder / "out/report.html");
  EXPECT_THAT(page, HasSubstr("Soft grains, t = "));
  EXPECT_THAT(page, HasSubstr("Network of forces"));
}

// Time steps take longer the more disks there are.
TEST(HardToSoftRun, HalfOfADropIsAQuarterOfItsWork) {
  dem::HardToSoftSetup setup;
  setup.source = "drop";
  setup.grains = 8;
  setup.max_time = 1;
  const auto run = dem::make_hard_to_soft_run(setup, 1);
  const double half = 0.5 * setup.drop_time();
  while (run->progress().simulated_time < half) run->advance(1);
  EXPECT_NEAR(setup.drop_time() / setup.time_unit(), 24, 1e-9);
  EXPECT_NEAR(run->progress().fraction, 3.0 / 13, 2e-3);
}

// Contents of all outputs: on one thread and on three, and after stops.
TEST(HardToSoftRun, SameBitsOnAnyThreadsAndAfterStops) {
  const Folder folder;
  const std::string file =
      folder.write("x.toml", std::string(kRain) + "[output]\nreport = false\n");
  ASSERT_EQ(program("run " + file + " -o " + (folder / "one") + " --threads 1").code, 0);
  const auto one = testing::contents(folder / "one");
  EXPECT_GT(one.size(), 4U);
  ASSERT_EQ(program("run " + file + " -o " + (folder / "three") + " --threads 3").code, 0);
  EXPECT_EQ(testing::contents(folder / "three"), one);
  const std::string run = "run " + file + " -o " + (folder / "k") + " ";
  int stops = 0, code = 130;
  for (long at = 40; code == 130 && stops < 60; at += 61, ++stops) {
    code =
        program(run + (stops > 0 ? "--resume" : "") + " --stop-after-steps " + std::to_string(at))
            .code;
  }
  EXPECT_EQ(code, 0);
  EXPECT_GT(stops, 2);
  EXPECT_EQ(testing::contents(folder / "k"), one);
}

constexpr const char* kDrop = R"(title = "drop"
study = "hard-to-soft"
[switch]
source = "drop"
grains = 20
friction = "viscous"
static_friction = 1
well = 1e-2
restitution = 0.3
step = 10
max_time = 60
[ensemble]
realizations = 1
)";

// A pile of disks that were dropped one at a time, by the source's own laws.
TEST(HardToSoftRun, DropsAPileThatRests) {
  const Folder folder;
  const Output out = program("run " + folder.write("x.toml", kDrop) + " -o " + (folder / "out"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(s));
  EXPECT_EQ(number(s, "dem.grains"), 20);
  EXPECT_EQ(number(s, "switch.soft_share"), 1);
  EXPECT_NEAR(number(s, "base.weight_ratio"), 1, 0.03);
  EXPECT_LT(number(s, "switch.balance_error"), 1e-6);
  const dem::Snapshot pile =
      dem::read_snapshot(folder / "out/snapshots.h5", "/realization_000/pile");
  double top = 0, fastest = 0;
  for (const dem::Grain& g : pile.grains) {
    top = std::max(top, g.position.y() / (2 * g.radius));
    fastest = std::max(fastest, g.velocity.norm() / std::sqrt(9.81 * 2 * g.radius));
  }
  EXPECT_GT(top, 1.2);  // no single row
  EXPECT_LT(fastest, 0.02);
}

TEST(HardToSoftRun, ADropStopsAndGoesOnToTheSameBits) {
  const Folder folder;
  const std::string file =
      folder.write("x.toml", std::string(kDrop) + "[output]\nreport = false\n");
  const std::string few = " --set switch.grains=6 --set switch.max_time=8";
  ASSERT_EQ(program("run " + file + " -o " + (folder / "one") + few).code, 0);
  const std::string run = "run " + file + " -o " + (folder / "k") + few + " ";
  int stops = 0, code = 130;
  for (long at = 70; code == 130 && stops < 60; at += 113, ++stops) {
    code =
        program(run + (stops > 0 ? "--resume" : "") + " --stop-after-steps " + std::to_string(at))
            .code;
  }
  EXPECT_EQ(code, 0);
  EXPECT_GT(stops, 3);
  EXPECT_EQ(testing::contents(folder / "k"), testing::contents(folder / "one"));
}

TEST(HardToSoftRun, MistakesAreNamed) {
  const Folder folder;
  const Output out = program("check " + folder.write("x.toml", std::string(kRain)) +
                             " --set switch.restitution=1.5");
  EXPECT_EQ(out.code, 2);
  EXPECT_THAT(out.err, HasSubstr("switch.restitution: found 1.5, allowed: 0 to 1"));
}

}  // namespace
}  // namespace grainfield::coupling
