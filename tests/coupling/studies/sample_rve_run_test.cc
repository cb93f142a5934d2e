// RVEs of small samples and their unloading, through the real program.
#include <gmock/gmock.h>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "tests/coupling/check_scene.h"
#include "tests/coupling/reliability_process.h"
#include "tests/coupling/run_scene.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::number;
using testing::Output;
using testing::program;

constexpr const char* kSpheres = R"(study = "sample"
[sample]
dim = 3
shape = "sphere"
grains = 120
radius = 0.001
pressure = 1e5
start_fraction = 0.3
compression_rate = 20
prepared_with = "other_friction"
prepared_friction = 0.3
deformation = "uniaxial"
strain = 0.01
strain_rate = 2
records = 4
unload = "stress"
unload_records = 3
[rve]
along = 2
radii = [2, 3]
[material]
law = "hertz"
density = 2500
young = 1e8
damping = 0.3
damping_model = "critical"
tangential_memory = "force"
wall_friction = 0.5
[rest]
background_damping = 200
unbalanced_force_ratio = 1e-3
kinetic_to_elastic_energy = 1e-4
[ensemble]
realizations = 2
)";

Summary run(const Folder& folder, const std::string& options, const std::string& out = "out") {
  const std::string file = folder.write("x.toml", kSpheres);
  const Output output = program("run " + file + " -o " + (folder / out) + " " + options);
  EXPECT_EQ(output.code, 0) << output.err;
  if (output.code != 0) return {};
  Summary summary = read_summary(folder / (out + "/summary.json"));
  EXPECT_NO_THROW(require_documented(summary));
  return summary;
}

TEST(SampleRves, TellStressAndStrainOfTheirSample) {
  for (const char* boundary : {"periodic", "walls"}) {
    const Folder folder;
    const Summary summary = run(folder, std::string("--set sample.boundary=") + boundary);
    const double fraction = number(summary, "sample.initial_solid_fraction");
    for (const double radius : {2.0, 3.0}) {
      const auto of = [&](const char* key) {
        return number(summary, "rve.r" + std::string(radius == 2 ? "2" : "3") + "." + key);
      };
      // Grains per volume times the volume; eight RVEs of 5 and 17 grains scatter, walls order.
      EXPECT_NEAR(of("grains") / (fraction * radius * radius * radius), 1, 0.2);
      // Eq. 29 at rest: as good as the rest is, 1e-3, times places of some grains' size.
      EXPECT_LT(of("closure"), 5e-3) << boundary;
      EXPECT_NEAR(of("strain_ratio"), 1, 0.15) << boundary << radius;
      EXPECT_NEAR(of("fit_ratio"), 1, 0.1) << boundary << radius;
      EXPECT_NEAR(of("grain_stress_ratio"), 1, 0.3) << boundary << radius;
      // The volume of eq. 29 drops out.
      EXPECT_NEAR(of("axial_stress_ratio"), number(summary, "sample.end_axial_stress_ratio"), 0.4)
          << boundary << radius;
      // Over the hull of the centres, which leaves out half of every outer grain.
      EXPECT_GT(of("stress_ratio"), 1.2) << boundary << radius;
    }
    // The whole deviator is that of the axes, and more.
    const double axial = number(summary, "sample.end_axial_stress_ratio");
    EXPECT_GT(axial, 0) << boundary;
    EXPECT_LE(axial, number(summary, "sample.end_stress_ratio")) << boundary;
    EXPECT_GT(axial, 0.7 * number(summary, "sample.end_stress_ratio")) << boundary;
    EXPECT_LT(number(summary, "rve.r3.error_bar"), number(summary, "rve.r2.error_bar"));
    EXPECT_GT(number(summary, "sample.plastic_strain"), 0);
    EXPECT_LT(number(summary, "sample.plastic_strain"), 0.01);
    EXPECT_GT(number(summary, "sample.loop_loss"), 0);
    EXPECT_GT(number(summary, "sample.unloading_stiffness"), 1);
    EXPECT_THAT(testing::read_text(folder / "out/rve_hull.vtu"), HasSubstr("displacement_z"));
    EXPECT_THAT(testing::read_text(folder / "out/report.html"),
                HasSubstr("An RVE with its convex hull"));
  }
}

TEST(SampleRves, KeysMeanNothingInThePlane) {
  const Folder folder;
  const std::string file = folder.write("x.toml", "study = \"sample\"\n[rve]\nalong = 2\n");
  const Output output = program("check " + file);
  EXPECT_THAT(output.err, HasSubstr("rve.along"));
}

}  // namespace
}  // namespace grainfield::coupling
