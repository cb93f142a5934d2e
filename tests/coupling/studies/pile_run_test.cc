// A tiny pile through the real program: every output, the same bits on any number of threads and
// after being stopped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <random>
#include <sstream>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "dem/snapshot/snapshot.h"
#include "tests/coupling/program.h"
#include "tests/paths.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Output;
using testing::program;

// Soft grains ten times Roul's size: a step is long.
std::string tiny_pile(const std::string& more = "") {
  return R"(title = "tiny pile"
study = "pile"
[shape]
radius = 0.0275
polydispersity = 0.1
[source]
grains = 40
height = 0.5
interval = 0.12
[floor]
length = 4.0
[material]
young = 1e6
[rest]
background_damping = 300
unbalanced_force_ratio = 1e-3
kinetic_to_elastic_energy = 1e-5
[ensemble]
realizations = 2
[average]
points = 21
map_columns = 9
map_rows = 5
[heap]
heights = [0.25]
)" + more;
}

std::map<std::string, std::string> results_of(const Folder& folder, const std::string& name,
                                              const std::string& options) {
  const std::string file = folder.write("x.toml", tiny_pile("[output]\nreport = false\n"));
  const Output output = program("run " + file + " -o " + (folder / name) + " " + options);
  EXPECT_EQ(output.code, 0) << output.err;
  return testing::contents(folder / name);
}

TEST(PileRun, LeavesEverything) {
  const Folder folder;
  const std::string file = folder.write(
      "x.toml", tiny_pile("[change]\ngravity = [8.829]\nmethod = \"damped\"\nramp_time = 0.05\n"
                          "[compare]\nmodels = [\"hydrostatic\", \"cantelaube\", \"ife\"]\n"
                          "[model.cantelaube]\nphi_deg = 20\n[model.ife]\nphi_deg = 20\n"
                          "[model.hydrostatic]\nleft_deg = 20\nright_deg = 20\n"));
  const Output run = program("run " + file + " --set source.record=[20] -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("hether there is a pressure dip needs at least 3 realizations"));
  for (const char* name : {"summary.json", "profiles.csv", "profiles.md", "profiles.tex",
                           "fields.h5", "fields.xdmf", "snapshots.h5", "states/grains_pile.vtu",
                           "states/chains_pile.vtu", "states/grains_gravity_8.829.vtu",
                           "states/grains_poured_20.vtu", "report.html", "case.toml"}) {
    EXPECT_TRUE(testing::fs::exists(folder / ("out/" + std::string(name)))) << name;
  }
  EXPECT_FALSE(testing::fs::exists(folder / "out/checkpoint"));
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(s));
  for (const char* key : {"dem.grains",
                          "dem.steps",
                          "dem.repose_angle_left_deg",
                          "dem.repose_angle_right_deg",
                          "heap.volume_fraction",
                          "heap.rho_g_h",
                          "pile.height",
                          "dip.ratio",
                          "dip.difference",
                          "dip.p_value",
                          "dip.window_ratio",
                          "density.ratio",
                          "base.largest_pressure",
                          "compare.hydrostatic.rel_l2",
                          "compare.cantelaube.base.rel_l2",
                          "compare.ife.rel_l2",
                          "model.cantelaube.beta_hat_deg",
                          "change.gravity_8.829.coordination_ratio",
                          "source.interval",
                          "sleep.wake_reach",
                          "dem.grain_steps",
                          "time.dem_cpu_s",
                          "time.dem_s"}) {
    EXPECT_EQ(s.count(key), 1U) << key;
  }
  EXPECT_GT(std::get<double>(s.at("time.dem_cpu_s")), 0);
  // The pile is at rest only to 1e-3.
  EXPECT_NEAR(std::get<double>(s.at("base.weight_ratio")), 1, 0.02);
  const std::string csv = testing::read_text(folder / "out/profiles.csv");
  EXPECT_THAT(csv, HasSubstr("# h = "));
  EXPECT_THAT(csv, HasSubstr("x from the apex"));
  EXPECT_THAT(csv, HasSubstr("\nbase,"));
  EXPECT_THAT(csv, HasSubstr("\nheight 0.25 h,"));
  EXPECT_THAT(csv, HasSubstr("\nbase coarse_graining,"));
  EXPECT_THAT(csv, HasSubstr("\nbase particle_centre,"));
  const auto names = dem::list_snapshots(folder / "out/snapshots.h5");
  EXPECT_EQ(names.size(), 6U);
  const auto pile = dem::read_snapshot(folder / "out/snapshots.h5", "/realization_001/pile");
  EXPECT_EQ(pile.grains.size(), 40U);
  EXPECT_GE(pile.grains.front().outline.size(), 6U);
  EXPECT_THAT(program("info " + (folder / "out/snapshots.h5")).out,
              HasSubstr("realization_000/gravity_8.829: 2D, "));
}

// Grains are fixed with their tops at y = 0, where the simulation measures from; the plane far
// below them is no floor.
TEST(PileRun, ReportTellsWhatChangedGravityDid) {
  const Folder folder;
  const std::string file = folder.write("x.toml", tiny_pile());
  const Output run = program("run " + file + " -o " + (folder / "out") +
                             " --set change.gravity=[8.829,20.0,5.0] --set source.grains=25");
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string page = testing::read_text(folder / "out/report.html");
  EXPECT_THAT(page, HasSubstr("<h2>Changed gravity</h2>"));
  const auto row = [&](const char* gravity) { return page.find(std::string("<td>") + gravity); };
  ASSERT_NE(row("20 m/s2"), std::string::npos);
  EXPECT_LT(row("5 m/s2"), row("8.829 m/s2"));
  EXPECT_LT(row("8.829 m/s2"), row("20 m/s2"));
  EXPECT_THAT(page, HasSubstr("contacts opened"));
  EXPECT_THAT(page, HasSubstr("2 piles, 25 grains each"));
  EXPECT_THAT(page, HasSubstr("themselves uncertain by 71 %"));
  EXPECT_THAT(page, HasSubstr("(repose.mean_deg)"));
  // What stands counts of piles from files, not what the case would pour.
  const Output again =
      program("run " + file + " -o " + (folder / "again") + " --set source.grains=30" +
              " --set 'grains.files=[\"" + (folder / "out/snapshots.h5") + "\"]'");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(testing::read_text(folder / "again/report.html"),
              HasSubstr("2 piles, 25 grains each"));
}

TEST(PileRun, ARoughFloorLiesAtTheTopsOfItsGrains) {
  const Folder folder;
  const std::string file = folder.write("x.toml", tiny_pile("[output]\nreport = false\n"));
  const Output run = program("run " + file + " -o " + (folder / "out") +
                             " --set floor.kind=rough --set ensemble.realizations=1");
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary s = read_summary(folder / "out/summary.json");
  const auto figure = [&](const char* key) { return std::get<double>(s.at(key)); };
  const double fraction = figure("heap.volume_fraction");
  EXPECT_GT(fraction, 0.65);
  EXPECT_LT(fraction, 0.95);
  // rho g h of the analysis with the h of the simulation; 5000 kg/m2 by default.
  EXPECT_NEAR(figure("heap.rho_g_h"), 5000 * fraction * 9.81 * figure("pile.height"),
              1e-9 * figure("heap.rho_g_h"));
  EXPECT_NEAR(figure("base.weight_ratio"), 1, 2e-3);
}

TEST(PileRun, AFlatPileIsSaidToHaveNoApex) {
  const Folder folder;
  const std::string run = "run " + folder.write("x.toml", tiny_pile()) + " -o " + (folder / "out");
  const Output flat = program(run + " --set source.grains=4");
  ASSERT_EQ(flat.code, 0) << flat.err;
  const std::string why = "no heap formed in 2 of 2 piles: realization 0: ";
  EXPECT_THAT(flat.err, HasSubstr("warning: " + why));
  const std::string summary = testing::read_text(folder / "out/summary.json");
  EXPECT_THAT(summary, HasSubstr(why));
  EXPECT_THAT(summary, HasSubstr("No heap formed in 2 of 2 piles. "));
  const std::string page = testing::read_text(folder / "out/report.html");
  EXPECT_THAT(page, HasSubstr(why));
  EXPECT_THAT(page, HasSubstr("- (no line fits a flank of 2 of 2 piles)"));
}

TEST(PileRun, SameBitsOnAnyThreadsAndAfterAStop) {
  const Folder folder;
  const auto one = results_of(folder, "one", "--threads 1");
  EXPECT_EQ(one, results_of(folder, "three", "--threads 3"));
  const std::string run = "run " + (folder / "x.toml") + " -o " + (folder / "stopped");
  for (const char* how : {"3000", "20000 --resume"}) {
    const Output stopped = program(run + " --threads 2 --stop-after-steps " + how);
    ASSERT_EQ(stopped.code, 130) << stopped.err;
  }
  ASSERT_EQ(program(run + " --resume --threads 2").code, 0);
  EXPECT_EQ(one, testing::contents(folder / "stopped"));
}

// Killed without warning at random, in the middle of a step or of writing a checkpoint, while many
// grains sleep.
TEST(PileRun, SameBitsAfterKills) {
  const Folder folder;
  const std::string run =
      "run " + folder.write("x.toml", tiny_pile("[output]\nreport = false\n")) +
      " --set source.grains=200 --set floor.length=8 --set source.height=1 --set rest.max_time=30 "
      "--set sleep.wake_reach=0.3 --set sleep.quiet_move=0.01 --set ensemble.realizations=1 "
      "--threads 1 ";
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(program(run + "-o " + (folder / "whole")).code, 0);
  const double whole_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto whole = testing::contents(folder / "whole");
  std::mt19937 random(std::random_device{}());
  int kills = 0, resumed = 0;
  Output output;
  do {
    const double seconds = whole_seconds * std::uniform_real_distribution(0.05, 0.35)(random);
    resumed += testing::fs::exists(folder / "killed/checkpoint/realization_000.h5.checkpoint");
    const bool begun = testing::fs::exists(folder / "killed/checkpoint");
    output = program(
        run + "--checkpoint-seconds 0 " + (begun ? "--resume" : "") + " -o " + (folder / "killed"),
        "timeout -s KILL " + std::to_string(seconds));
    kills += output.code == 137;
  } while (output.code == 137 && kills < 200);
  // The last kill may have come between the run's end and the program's: then something that the
  // program takes away in the end may still be there.
  const bool finished_before = output.err.find("is finished") != std::string::npos;
  if (!finished_before) {
    ASSERT_EQ(output.code, 0) << output.err;
  }
  EXPECT_GT(kills, 2);
  EXPECT_GT(resumed, 1);
  const auto pieces = testing::contents(folder / "killed");
  if (!finished_before) {
    EXPECT_EQ(pieces.size(), whole.size());
  }
  for (const auto& [name, text] : whole) {
    ASSERT_EQ(pieces.count(name), 1U) << name;
    EXPECT_TRUE(pieces.at(name) == text) << name << " differs after " << kills << " kills";
  }
}

TEST(PileRun, MoreRealizationsReuseTheGrainsOfAFailedAnalysis) {
  const Folder folder;
  const std::string file = folder.write("x.toml", tiny_pile("[output]\nreport = false\n"));
  const std::string run = "run " + file + " -o " + (folder / "out");
  const Output failed = program(run + " --set average.width=1e-6");
  EXPECT_EQ(failed.code, 2) << failed.err;
  EXPECT_THAT(failed.err, HasSubstr("; the grains are kept in "));
  const auto made = testing::fs::last_write_time(folder / "out/checkpoint/realization_001.h5");
  EXPECT_EQ(program(run + " --resume --set average.width=1e-6 --set ensemble.realizations=3").code,
            2);
  EXPECT_EQ(testing::fs::last_write_time(folder / "out/checkpoint/realization_001.h5"), made);
  const Output done = program(run + " --resume --set ensemble.realizations=3");
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(
      std::get<std::int64_t>(read_summary(folder / "out/summary.json").at("ensemble.realizations")),
      3);
}

// Forty grains have no flanks to measure: the user has to say how steep they are.
TEST(PileRun, WarnsOfGrainsThatAreTooSoft) {
  const Folder folder;
  const std::string run = "run " + folder.write("x.toml", tiny_pile("[output]\nreport = false\n")) +
                          " --set source.grains=25 --set ensemble.realizations=1 -o ";
  EXPECT_THAT(program(run + (folder / "stiff")).err, Not(HasSubstr("too soft")));
  const Output soft = program(run + (folder / "soft") + " --set material.young=3e4");
  EXPECT_EQ(soft.code, 0) << soft.err;
  EXPECT_THAT(soft.err, HasSubstr("too soft for a contact law"));
}

TEST(PileRun, FrictionAngleIsNotGuessed) {
  const Folder folder;
  const std::string file = folder.write(
      "x.toml", tiny_pile("[compare]\nmodels = [\"bcc\"]\n[output]\nreport = false\n"));
  const std::string run = "run " + file + " -o " + (folder / "out");
  const Output refused = program(run);
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("model bcc: phi_deg cannot be measured on this heap"));
  const Output done = program(run + " --resume --set model.bcc.phi_deg=20");
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(testing::read_text(folder / "out/profiles.csv"), HasSubstr(",bcc"));
}

TEST(PileRun, SweepComparesMembers) {
  const Folder folder;
  const std::string file = folder.write(
      "x.toml", tiny_pile("[output]\nvtu = false\n[sweep]\nkey = \"sleep.on\"\nvalues = [true, "
                          "false]\n"));
  const Output run = program(
      "run " + file + " --set ensemble.realizations=1 --set floor.length=6 -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary all = read_summary(folder / "out/summary.json");
  EXPECT_EQ(all.count("dip.ratio.on_true"), 1U);
  EXPECT_EQ(all.count("dip.ratio.on_false"), 1U);
  EXPECT_THAT(testing::read_text(folder / "out/report.html"), HasSubstr("repose (deg)"));
}

// On the page below the case's heading, and at the head of the case file.
TEST(PileRun, SweepsThatThePagesNameAreAccepted) {
  const std::string cases = GRAINFIELD_CASES;
  const std::string page = testing::read_text(cases + "/../docs/cases/pile-dip.md");
  for (const std::string name : {"pile-dip-controls", "pile-dip-funnel"}) {
    const std::string file = cases + "/" + name + ".toml";
    std::istringstream lines(testing::read_text(file) + "## " + name + "\n" +
                             page.substr(page.find("## " + name) + 3));
    int sweeps = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("## ") && !line.ends_with(name)) break;
      if (!line.starts_with("    --set ") && !line.starts_with("#   --set ")) continue;
      const Output check = program("check " + file + line.substr(3));
      EXPECT_EQ(check.code, 0) << name << line << "\n" << check.err;
      ++sweeps;
    }
    EXPECT_GE(sweeps, 4) << name;
  }
}

}  // namespace
}  // namespace grainfield::coupling
