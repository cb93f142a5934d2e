// motion.energy_balance in cases: what a run tells of where its energy went.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

constexpr const char* kLayer = R"(study = "point-load"
[packing]
kind = "triangular"
columns = 12
rows = 5
sizes = "mono"
[ensemble]
realizations = 1
[rest]
unbalanced_force_ratio = 1e-4
kinetic_to_elastic_energy = 1e-6
[load]
force = 20
ramp_time = 0.02
[motion]
energy_balance = true
)";
constexpr const char* kPile = R"(study = "pile"
[shape]
radius = 0.0275
polydispersity = 0.1
[source]
grains = 30
height = 0.5
interval = 0.15
[floor]
length = 4.0
[material]
young = 1e6
[sleep]
on = false
[motion]
energy_balance = true
[rest]
background_damping = 300
unbalanced_force_ratio = 1e-3
kinetic_to_elastic_energy = 1e-5
[ensemble]
realizations = 1
[heap]
heights = [0.25]
)";

std::map<std::string, double> energies(const std::string& text, const std::string& sets) {
  const Folder folder;
  folder.write("case.toml", text);
  const Output out =
      program("run " + (folder / "case.toml") + " -o " + (folder / "run") + " " + sets);
  EXPECT_EQ(out.code, 0) << out.err;
  std::map<std::string, double> found;
  const auto summary = nlohmann::json::parse(testing::read_text(folder / "run/summary.json"));
  for (const auto& [key, value] : summary.items()) {
    if (key.starts_with("energy.")) found[key.substr(7)] = value.get<double>();
  }
  EXPECT_EQ(testing::read_text(folder / "run/report.html").find("energy.work_of_gravity") ==
                std::string::npos,
            found.empty());
  return found;
}

// What is there and lost is what came in; and the law's share tells a gradient from none.
TEST(EnergyRun, APouredPileLosesWhatItFell) {
  const auto shared = [](const std::map<std::string, double>& e) {
    const double in = e.at("brought") + e.at("work_of_gravity");
    const double there = e.at("kinetic") + e.at("elastic");
    const double lost =
        e.at("lost_in_dashpots") + e.at("lost_to_friction") + e.at("lost_to_damping");
    EXPECT_GT(e.at("lost_to_friction"), 0.02 * in);
    EXPECT_GT(e.at("lost_in_dashpots"), 0.2 * in);
    EXPECT_LT(std::fabs(e.at("balance_error")), 1e-3);
    EXPECT_NEAR(there + lost, in + e.at("work_of_law"), 1e-3 * in);
    EXPECT_EQ(e.at("lost_to_rolling"), 0);
    EXPECT_EQ(e.at("work_of_walls"), 0);
    return e.at("work_of_law") / in;
  };
  const double gradient = shared(energies(kPile, "--set material.law=energy"));
  const double none = shared(energies(kPile, ""));
  EXPECT_LT(std::fabs(gradient), 3e-3);
  EXPECT_GT(std::fabs(none), std::fabs(gradient));
}

TEST(EnergyRun, ALoadDoesWork) {
  const auto e = energies(kLayer, "");
  EXPECT_GT(e.at("work_of_load"), 0);
  EXPECT_LT(std::fabs(e.at("balance_error")), 1e-3);
  EXPECT_TRUE(energies(kLayer, "--set motion.energy_balance=false").empty());
}

TEST(EnergyRun, WhereItWouldNotHoldItIsRefused) {
  const auto expect_refused = [](const std::string& text, const std::string& sets,
                                 const std::string& line) {
    const Folder folder;
    folder.write("case.toml", text);
    const Output out = program("check " + (folder / "case.toml") + " " + sets);
    EXPECT_EQ(out.code, 2) << out.err;
    EXPECT_THAT(out.err, HasSubstr(line));
    EXPECT_EQ(std::count(out.err.begin(), out.err.end(), '\n'), 1) << out.err;
  };
  expect_refused(kLayer, "--set motion.integrator=gear",
                 "motion.energy_balance: found true with motion.integrator = \"gear\", allowed "
                 "with verlet");
  expect_refused(kLayer, "--set load.method=newton",
                 "load.method: found \"newton\" with motion.energy_balance = true, allowed: "
                 "\"damped\"");
  expect_refused(kPile, "--set change.gravity=[9]",
                 "change.method: found \"newton\" with motion.energy_balance = true");
}

}  // namespace
}  // namespace grainfield::coupling
