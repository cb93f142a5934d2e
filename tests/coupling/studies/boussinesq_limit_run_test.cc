// Layers of growing depth beside elasticity with their own moduli, from case file to report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "continuum/moduli_by_depth.h"
#include "coupling/case/case.h"
#include "coupling/result/tables.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling::testing {
namespace {

using ::testing::HasSubstr;

// Lattices of disks of slightly different sizes: nearly isotropic, and quick to come to rest.
const char* const kCase = R"(study = "boussinesq-limit"
[packing]
kind = "triangular"
sizes = "mono"
columns = 48
rows = 13
jitter = 0.001
[material]
friction = 0.9
[rest]
unbalanced_force_ratio = 1e-5
[load]
method = "newton"
force = 3
[response]
loads = 8
slabs = 3
[average]
points = 41
depths = [0.5]
width_diameters = 1.5
[ensemble]
realizations = 3
)";

double number(const Summary& s, const std::string& key) {
  EXPECT_EQ(s.count(key), 1U) << key;
  return s.count(key) > 0 ? std::get<double>(s.at(key)) : 0;
}

TEST(BoussinesqLimitRun, FromCaseToReport) {
  const Folder folder;
  const std::string file = folder.write("limit.toml", kCase);
  const Output run = program("run " + file + " -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_EQ(number(s, "response.places"), 8);
  EXPECT_LT(number(s, "response.out_of_balance"), 1e-6);
  EXPECT_GT(number(s, "response.base_over_load"), 0.6);
  EXPECT_GT(number(s, "response.settlement"), 0);
  // Moduli of the pressed lattice are below the closed form, as some contacts are open.
  EXPECT_GT(number(s, "moduli.E"), 0);
  EXPECT_GT(number(s, "moduli.E_v.standard_error"), 0);
  EXPECT_LT(number(s, "moduli.residual"), 0.2);
  // The load of the simulation: about a grain's weight.
  EXPECT_NEAR(number(s, "linearity.weights"), 1, 0.2);
  EXPECT_LT(number(s, "linearity.lost"), 0.1);
  // The first contact slides before it opens; more contacts need larger loads.
  EXPECT_GT(number(s, "linearity.first_changes"), 0);
  EXPECT_LE(number(s, "linearity.first_changes"), number(s, "linearity.first_slides"));
  EXPECT_LT(number(s, "linearity.first_slides"), number(s, "linearity.first_opens"));
  EXPECT_LT(number(s, "linearity.first_changes"), number(s, "linearity.hundredth_changes"));
  EXPECT_GT(number(s, "linearity.hundredth_changes.standard_error"), 0);
  for (const char* model :
       {"homogeneous_rough", "homogeneous_smooth", "homogeneous_half_space", "by_depth_rough",
        "by_depth_smooth", "by_depth_half_space", "homogeneous_centres", "by_depth_centres",
        "by_depth_inside", "homogeneous_half_space_centres", "by_depth_half_space_centres"}) {
    const std::string key = std::string("limit.") + model;
    for (const char* region : {".base", ".axis", ".all"}) {
      for (const char* width : {".w_diameters", ".w_depths"}) {
        const std::string one = key + region + width;
        EXPECT_GT(number(s, one + ".noise"), 0);
        EXPECT_GT(number(s, one + ".squared.standard_error"), 0);
        EXPECT_GE(number(s, one + ".right_to") * number(s, one + ".right_to"),
                  number(s, one + ".squared"));
      }
    }
  }
  // Few disks of a pressed lattice: near the prediction, not at it.
  for (const char* model : {"homogeneous_rough", "by_depth_rough", "by_depth_centres"}) {
    for (const char* where : {".surface", ".axis"}) {
      const std::string key = std::string("settlement.") + model + where;
      EXPECT_NEAR(number(s, key), 1, 0.5) << key;
      EXPECT_GT(number(s, key + ".standard_error"), 0) << key;
    }
  }
  const continuum::ModuliByDepth table =
      continuum::read_moduli_by_depth(folder / "out/moduli_by_depth.csv");
  EXPECT_NO_THROW(table.require_cover(number(s, "layer.depth")));
  EXPECT_THAT(read_text(folder / "out/displacements.csv"),
              HasSubstr("realization,place,at_over_h,displacement,homogeneous_rough,by_depth_rough,"
                        "by_depth_centres\n"));
  // Labels name the table of a model without its folder, which is gone.
  EXPECT_THAT(read_text(folder / "out/verdict.md"),
              HasSubstr("(base=rough, moduli=moduli_by_depth.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/.models_of_realization_000"));
  // The surface is level with the highest disks of the lattice.
  EXPECT_NEAR(number(s, "response.load_depth"), 0.0045, 1e-4);
  // Half a depth below the surface the load on the layer below these centres is nearer by twice
  // their share of the depth. Material above the load takes that back.
  const double share = number(s, "response.load_depth") / number(s, "layer.depth");
  const auto peak = [&](const std::string& model) {
    return number(s, "compare." + model + ".peak_over_F_per_h");
  };
  for (const std::string moduli : {"homogeneous", "by_depth"})
    EXPECT_NEAR(peak(moduli + "_centres") / peak(moduli + "_rough"), 1 + 2 * share, 0.5 * share);
  EXPECT_NEAR(peak("by_depth_inside") / peak("by_depth_rough"), 1, 0.5 * share);
  EXPECT_LE(number(s, "moduli.unbalanced_force_ratio"), 1e-9);
  EXPECT_THAT(read_text(folder / "out/report.html"), HasSubstr("by_depth_rough"));

  // From files, with another load: the same layers, the same moduli.
  const std::string more = "\n[grains]\nfiles = [\"" + (folder / "out/snapshots.h5") + "\"]\n";
  const std::string from = folder.write("from.toml", kCase + more);
  const Output again = program("run " + from + " -o " + (folder / "from") +
                               " --set response.grains=3 --set response.finite_elements=false");
  ASSERT_EQ(again.code, 0) << again.err;
  const Summary t = read_summary(folder / "from/summary.json");
  EXPECT_DOUBLE_EQ(number(t, "moduli.E"), number(s, "moduli.E"));
  EXPECT_LT(number(t, "response.settlement"), 0.9 * number(s, "response.settlement"));
  EXPECT_EQ(t.count("limit.by_depth_rough.base.w_depths.squared"), 0U);
  EXPECT_EQ(t.count("limit.homogeneous_rough.base.w_depths.squared"), 1U);
  // Grains of another friction are other grains.
  const Output other = program("check " + from + " --set material.friction=0.3");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("material.friction: found 0.3, the layer "));
}

TEST(BoussinesqLimitRun, RefusesWhatLinearResponseDoesNotKnow) {
  const Folder folder;
  const auto refusal = [&](const std::string& sets) {
    const Output out = program("check " + folder.write("x.toml", kCase) + " " + sets);
    EXPECT_EQ(out.code, 2) << out.err;
    return out.err;
  };
  EXPECT_THAT(refusal("--set packing.dim=3 --set packing.kind=random --set packing.sides=walls"
                      " --set packing.shape=superellipsoid --set material.law=hertz_elliptic"
                      " --set load.method=damped"),
              HasSubstr("packing.sides"));
  EXPECT_THAT(refusal("--set packing.dim=3 --set packing.kind=random --set material.law=hertz"
                      " --set load.method=damped"),
              HasSubstr("load.force: found 3 beside load.weights = 0.1"));
  EXPECT_THAT(refusal("--set average.map_columns=9"), HasSubstr("map_columns"));
}

}  // namespace
}  // namespace grainfield::coupling::testing
