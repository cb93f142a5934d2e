// Small lattice piles through the real program: base forces beside the closed forms, in every
// output, over a sweep of slopes; mistakes in the case.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "coupling/store/field_io.h"
#include "tests/coupling/program.h"
#include "tests/coupling/run_scene.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::number;
using testing::Output;
using testing::program;

std::string small_pile(const std::string& more = "") {
  return R"(title = "small lattice piles"
study = "lattice-pile"
[lattice]
base_grains = 9
[ensemble]
realizations = 1
[compare]
models = ["liffman"]
)" + more;
}

TEST(LatticePileRun, EquilateralPileMeetsTheClosedForm) {
  const Folder folder;
  const std::string file = folder.write("x.toml", small_pile());
  const Output output = program("run " + file + " -o " + (folder / "out"));
  ASSERT_EQ(output.code, 0) << output.err;
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(s));
  EXPECT_EQ(number(s, "dem.grains"), 45);
  EXPECT_EQ(number(s, "liffman.rows"), 9);
  EXPECT_EQ(number(s, "liffman.row_contacts"), 0);
  EXPECT_LT(number(s, "liffman.normal_max_error"), 1e-3);
  EXPECT_LT(number(s, "liffman.horizontal_max_error"), 2e-3);
  EXPECT_NEAR(number(s, "base.weight_ratio"), 1, 1e-6);
  EXPECT_NEAR(number(s, "liffman.softness"), 1e-6, 2e-8);
  // N = (k + 1) m g / 2 and H = m g tan(pi/6) (k - 1)/2; the lines have k instead of k + 1.
  const double weight = number(s, "liffman.grain_weight");
  EXPECT_NEAR(number(s, "liffman.normal_largest") / weight, 5, 5e-3);
  EXPECT_NEAR(number(s, "liffman.horizontal_largest") / weight, 4 / std::sqrt(3.0), 5e-3);
  EXPECT_NEAR(number(s, "liffman.line_normal_max_difference"), 1.0 / 9, 2e-3);
  EXPECT_LT(number(s, "compare.lattice.rel_l2"), 1e-3);
  EXPECT_NEAR(number(s, "compare.liffman.base.rel_l2"), 0.1, 2e-3);
  EXPECT_THAT(testing::read_text(folder / "out/profiles.csv"), HasSubstr("base sigma_xy,"));
  const Field base = read_field(folder / "out/fields.h5", "base");
  EXPECT_EQ(base.find("N")->value.size(), 9);
  EXPECT_NEAR(base.find("H_lattice")->value.sum(), 0, 1e-12);
  for (const char* name :
       {"report.html", "snapshots.h5", "states/grains_pile.vtu", "profiles.md"}) {
    EXPECT_TRUE(testing::fs::exists(folder / ("out/" + std::string(name)))) << name;
  }
  EXPECT_THAT(testing::read_text(folder / "out/report.html"), HasSubstr("45 disks in 9 rows"));
}

TEST(LatticePileRun, SweepOfSlopesShowsEveryLineModel) {
  const Folder folder;
  const std::string file = folder.write(
      "x.toml", small_pile("[sweep]\nkey = \"lattice.slope_deg\"\nvalues = [30, 45.5, 60]\n"));
  const Output output = program("run " + file + " -o " + (folder / "out") + " --threads 2");
  ASSERT_EQ(output.code, 0) << output.err;
  const Summary s = read_summary(folder / "out/summary.json");
  for (const char* slope : {"30", "45.5", "60"}) {
    const std::string end = std::string(".slope_deg_") + slope;
    EXPECT_LT(number(s, "liffman.normal_max_error" + end), 1e-3) << slope;
    EXPECT_LT(number(s, "liffman.horizontal_max_error" + end), 2e-3) << slope;
  }
  EXPECT_EQ(number(s, "dem.grains.slope_deg_30"), 9 + 6 + 3);
  const std::string report = testing::read_text(folder / "out/report.html");
  EXPECT_THAT(report, HasSubstr("Grains beside the models"));
  EXPECT_THAT(report, HasSubstr("45.5"));
}

// Any model of a heap can stand beside them: what it needs is filled in.
TEST(LatticePileRun, DoesWithoutModelsAndFillsTheirParameters) {
  const Folder folder;
  const std::string file = folder.write("x.toml", R"(study = "lattice-pile"
[lattice]
base_grains = 7
slope_deg = 40
[ensemble]
realizations = 2
[compare]
models = ["hydrostatic"]
[output]
report = false
)");
  ASSERT_EQ(program("run " + file + " -o " + (folder / "out")).code, 0);
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_EQ(number(s, "ensemble.realizations"), 2);
  EXPECT_EQ(number(s, "liffman.row_contacts.standard_error"), 0);
  EXPECT_GT(number(s, "compare.hydrostatic.rel_l2"), 0.05);
  EXPECT_EQ(program("run " + file + " -o " + (folder / "none") + " --set compare.models=[]").code,
            0);
}

TEST(LatticePileRun, MistakesAreNamed) {
  const Folder folder;
  const auto refusal = [&](const std::string& more) {
    const std::string file = folder.write("x.toml", small_pile(more));
    const Output output = program("check " + file);
    EXPECT_EQ(output.code, 2) << more;
    return output.err;
  };
  EXPECT_THAT(refusal("[material]\nwall_friction = 0.1\n"),
              HasSubstr("has no meaning for study = \"lattice-pile\""));
  EXPECT_THAT(refusal("[packing]\ncolumns = 4\n"), HasSubstr("has no meaning"));
  EXPECT_THAT(refusal("[motion]\ntime_step = 1.0\n"), HasSubstr("motion.time_step: found 1 s"));
  const std::string steep = folder.write("y.toml",
                                         "study = \"lattice-pile\"\n[lattice]\n"
                                         "slope_deg = 61\n");
  const Output output = program("check " + steep);
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("y.toml:3: lattice.slope_deg: found 61, allowed: 1 to 60"));
}

}  // namespace
}  // namespace grainfield::coupling
