// Gases of hard grains through the real program: pressure beside its equation of state, cooling
// beside Haff's law, the same bits, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "tests/coupling/check_scene.h"
#include "tests/coupling/run_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using testing::Folder;
using ::testing::HasSubstr;
using testing::number;
using testing::Output;
using testing::program;
using testing::run_of;
using testing::says;

std::string gas_case(const std::string& gas, int realizations = 2) {
  return "title = \"a gas\"\nstudy = \"hard-disks\"\n[gas]\n" + gas +
         "[ensemble]\nrealizations = " + std::to_string(realizations) + "\n";
}

// Two realizations of 900 disks and 100 collisions a grain: Z scatters by 0.3 %.
TEST(HardDisksRun, PressureIsHendersons) {
  const Folder folder;
  const Summary s = run_of(
      folder,
      gas_case("grains = 900\nfractions = [0.2, 0.5]\nequilibration = 20\ncollisions = 100\n"));
  EXPECT_NO_THROW(require_documented(s));
  EXPECT_EQ(number(s, "dem.grains"), 900);
  for (const char* f : {"0.2", "0.5"}) {
    const std::string name = "gas.fraction_" + std::string(f) + ".";
    EXPECT_NEAR(number(s, name + "compressibility_over_theory"), 1, 0.015) << f;
    EXPECT_NEAR(number(s, name + "compressibility_over_virial_series"), 1, 0.015) << f;
    EXPECT_NEAR(number(s, name + "collision_rate_over_enskog"), 1, 0.03) << f;
    EXPECT_LT(number(s, name + "energy_drift"), 1e-12) << f;
    EXPECT_EQ(number(s, name + "elastic_share"), 0) << f;
    EXPECT_EQ(number(s, name + "collisions"), 54000) << f;
    EXPECT_GT(number(s, name + "compressibility.standard_error"), 0) << f;
  }
  EXPECT_NEAR(number(s, "gas.fraction_0.5.theory"), 4.125, 1e-9);
  EXPECT_LT(number(s, "gas.pressure_largest_difference"), 0.015);
  EXPECT_LT(number(s, "gas.energy_drift_per_collision"), 1e-12);
  EXPECT_LT(number(s, "gas.overlap"), 1e-11);
  EXPECT_THAT(std::get<std::string>(s.at("verdict.sentence")),
              HasSubstr("The pressure differs from Henderson's by at most"));
  for (const char* text : {"<h2>Pressure</h2>", "Henderson", "<h2>At the end</h2>",
                           "<h2>Pressure and collisions</h2>", "virial series"}) {
    EXPECT_TRUE(says(folder / "out/report.html", text)) << text;
  }
  const std::string table = testing::read_text(folder / "out/profiles.csv");
  EXPECT_THAT(table,
              HasSubstr("fraction,compressibility,compressibility_error,theory,virial_series"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
  for (const char* name :
       {"snapshots.h5", "states/grains_fraction_0.2.vtu", "states/grains_fraction_0.5.vtu"}) {
    EXPECT_TRUE(testing::fs::exists(folder / ("out/" + std::string(name)))) << name;
  }
}

TEST(HardDisksRun, CoolingIsHaffs) {
  const Folder folder;
  const Summary s = run_of(folder, gas_case("kind = \"cooling\"\ngrains = 900\nfractions = [0.2]\n"
                                            "equilibration = 20\nrestitution = 0.95\n"
                                            "cool_to = 0.2\nrecords = 9\n"));
  EXPECT_NO_THROW(require_documented(s));
  EXPECT_NEAR(number(s, "gas.fraction_0.2.temperature_over_haff"), 1, 0.05);
  EXPECT_LT(number(s, "gas.haff_largest_difference"), 0.06);
  EXPECT_LT(number(s, "gas.fraction_0.2.energy_drift"), 1e-11);
  const std::string table = testing::read_text(folder / "out/profiles.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 10);
  EXPECT_THAT(table, HasSubstr("\n0.2,0,0,1,"));
  EXPECT_TRUE(says(folder / "out/report.html", "While Haff's law cools the gas to 0.2 of its"));
  EXPECT_TRUE(says(folder / "out/report.html", "<h2>Cooling</h2>"));
}

// Rough spheres take up spins, and no law of smooth ones is told.
TEST(HardDisksRun, RoughSpheresSpin) {
  const Folder folder;
  const Summary s = run_of(
      folder, gas_case("shape = \"sphere\"\nkind = \"cooling\"\ngrains = 500\nfractions = [0.1]\n"
                       "friction = 0.5\ncool_to = 0.3\nequilibration = 5\nrecords = 5\n"));
  EXPECT_NO_THROW(require_documented(s));
  EXPECT_EQ(s.count("gas.haff_largest_difference"), 0U);
  std::istringstream rows(testing::read_text(folder / "out/profiles.csv"));
  std::string last;
  for (std::string row; std::getline(rows, row);) last = row;
  std::vector<std::string> cells;
  std::istringstream line(last);
  for (std::string cell; std::getline(line, cell, ',');) cells.push_back(cell);
  ASSERT_EQ(cells.size(), 8U);
  EXPECT_EQ(cells[5], "nan");
  EXPECT_GT(std::stod(cells[6]), 0.01);                 // spins
  EXPECT_LT(std::stod(cells[6]), std::stod(cells[3]));  // colder than the motion
}

// With events of all kinds: mixing, pressure, cooling, contact time, several fractions.
TEST(HardDisksRun, SameBitsOnAnyThreadsAndAfterStops) {
  for (const char* kind :
       {"kind = \"pressure\"\ncollisions = 20\n",
        "kind = \"cooling\"\nrestitution = 0.7\nfriction = 0.2\ncontact_time = 1e-5\n"}) {
    const Folder folder;
    const std::string text =
        gas_case(std::string(kind) + "grains = 200\nfractions = [0.3, 0.1]\nequilibration = 20\n",
                 3) +
        "[output]\nreport = false\n";
    run_of(folder, text, "--threads 1", "one");
    const auto one = testing::contents(folder / "one");
    EXPECT_GT(one.size(), 5U);
    run_of(folder, text, "--threads 3", "three");
    EXPECT_EQ(testing::contents(folder / "three"), one);
    const std::string run =
        "run " + (folder / "x.toml") + " -o " + (folder / "k") + " --threads 2 ";
    int stops = 0, code = 130;
    for (long at = 1500; code == 130 && stops < 100; at += 3300, ++stops) {
      code =
          program(run + (stops > 0 ? "--resume" : "") + " --stop-after-steps " + std::to_string(at))
              .code;
    }
    EXPECT_EQ(code, 0);
    EXPECT_GT(stops, 3);
    EXPECT_EQ(testing::contents(folder / "k"), one);
  }
}

TEST(HardDisksRun, CollapseEndsWithWhatToChange) {
  const Folder folder;
  const std::string file =
      folder.write("x.toml", gas_case("kind = \"cooling\"\ngrains = 256\nfractions = [0.5]\n"
                                      "restitution = 0.05\ncool_to = 1e-8\nequilibration = 5\n",
                                      1));
  const Output output = program("run " + file + " -o " + (folder / "out"));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("an inelastic collapse with a contact time of 0 s"));
  EXPECT_THAT(output.err, HasSubstr("(gas.contact_time, gas.restitution)"));
  EXPECT_EQ(
      program("run " + file + " -o " + (folder / "out") + " --set gas.contact_time=1e-4").code, 0);
}

TEST(HardDisksCheck, RefusesWhatRunWould) {
  const auto refusal = [](const std::string& gas) { return complaint(gas_case(gas)); };
  EXPECT_EQ(refusal(""), "");
  EXPECT_THAT(refusal("kind = \"cooling\"\nrestitution = 1.2\n"),
              HasSubstr("x.toml:5: gas.restitution: found 1.2, allowed: 0 to 1"));
  EXPECT_THAT(refusal("kind = \"cooling\"\nrestitution = 1\n"),
              HasSubstr("x.toml:5: gas.restitution: found 1 with gas.kind \"cooling\", allowed: "
                        "below 1"));
  EXPECT_THAT(refusal("grains = 100\nfractions = [0.3, 0.89]\n"),
              HasSubstr("x.toml:5: gas.fractions: found 0.89, which 100 disks in a square cannot "
                        "fill, allowed: at most 0.787"));
  EXPECT_THAT(refusal("shape = \"sphere\"\nfractions = [0.75]\n"),
              HasSubstr("x.toml:5: gas.fractions: found 0.75, which 10000 spheres in a cube"));
  EXPECT_THAT(refusal("fractions = [0.95]\n"), HasSubstr("allowed: 0.0001 to 0.9"));
  EXPECT_THAT(
      refusal("grains = 8\nfractions = [0.7]\n"),
      HasSubstr("x.toml:4: gas.grains: found 8, at a fraction of 0.7 in a box of 0.00599 m"));
  EXPECT_THAT(refusal("fractions = [0.3, 0.30000001]\n"),
              HasSubstr("x.toml:4: gas.fractions: found 0.30000001 beside 0.3"));
  EXPECT_THAT(refusal("collisions = 1e8\n"),
              HasSubstr("x.toml:4: gas.collisions: found 1e+08, 1.5e+12 collisions in all"));
  EXPECT_THAT(refusal("restituton = 0.5\n"), HasSubstr("did you mean gas.restitution"));
  const Folder folder;
  const Output output = program(
      "check " + folder.write("x.toml", gas_case("shape = \"sphere\"\nfractions = [0.75]\n")));
  EXPECT_EQ(output.code, 2);
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
}

}  // namespace
}  // namespace grainfield::coupling
