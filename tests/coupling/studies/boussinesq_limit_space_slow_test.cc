// A layer of superellipsoids beside elasticity with its own moduli, from case file to table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/result/tables.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling::testing {
namespace {

// Some 500 soft ones, five diameters deep.
const char* const kCase = R"(study = "boussinesq-limit"
[packing]
dim = 3
kind = "random"
sizes = "uniform"
shape = "superellipsoid"
radius_min = 0.0045
radius_max = 0.0055
width = 0.1
depth = 0.05
[material]
law = "hertz_elliptic"
density = 2500
young = 1e6
poisson = 0.3
damping = 0.3
friction = 0.5
floor_friction = 0.5
[motion]
local_damping = 0.2
[rest]
background_damping = 10
unbalanced_force_ratio = 1e-5
kinetic_to_elastic_energy = 1e-5
[load]
weights = 0
force = 0.0065
ramp_time = 0.05
[ensemble]
realizations = 1
seed = 1
[average]
kernel = "lucy"
width_diameters = 1.5
depths = [0.5]
points = 21
[response]
loads = 9
slabs = 1
)";

TEST(BoussinesqLimitSpaceSlow, OfSuperellipsoids) {
  const Folder folder;
  const Output run =
      program("run " + folder.write("limit.toml", kCase) + " -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary s = read_summary(folder / "out/summary.json");
  const auto number = [&](const std::string& key) {
    EXPECT_EQ(s.count(key), 1U) << key;
    return s.count(key) > 0 ? std::get<double>(s.at(key)) : 0;
  };
  EXPECT_GT(number("response.places"), 5);
  EXPECT_LT(number("response.out_of_balance"), 1e-6);
  EXPECT_NEAR(number("response.base_over_load"), 1, 1e-6);  // sides repeat
  EXPECT_LE(number("moduli.unbalanced_force_ratio"), 1e-7);
  EXPECT_GT(number("response.settlement"), 0);
  // Softer than the grains' own material, stiffer than nothing.
  EXPECT_GT(number("moduli.E_v"), 1e4);
  EXPECT_LT(number("moduli.E_v"), 2e5);
  EXPECT_GT(number("moduli.G_v"), 0);
  // One slab: the moduli by depth are those of the whole, so finite elements and the closed forms
  // predict the same, stress and settlement.
  for (const char* base : {"rough", "smooth", "half_space", "centres"}) {
    const auto peak = [&](const char* model) {
      return number(std::string("compare.") + model + base + ".peak_over_F_per_h");
    };
    EXPECT_NEAR(peak("by_depth_") / peak("homogeneous_"), 1, 0.02) << base;
  }
  for (const char* place : {".surface", ".axis"}) {
    EXPECT_NEAR(number(std::string("settlement.by_depth_rough") + place) /
                    number(std::string("settlement.homogeneous_rough") + place),
                1, 0.02)
        << place;
  }
}

}  // namespace
}  // namespace grainfield::coupling::testing
