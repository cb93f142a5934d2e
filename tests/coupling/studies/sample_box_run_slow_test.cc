// Superellipsoids in a box through the real program: small strains, the block of finite elements
// beside the grains, grains that are dropped, kills, and mistakes.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <sstream>

#include "continuum/constants.h"
#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "tests/coupling/check_scene.h"
#include "tests/coupling/run_scene.h"
#include "tests/coupling/sample_bits_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using testing::Folder;
using ::testing::HasSubstr;
using testing::number;
using testing::Output;
using testing::program;

// cases/box-compression.toml and its like, small.
std::string box(const std::string& sample, const std::string& rest = "") {
  return R"(study = "sample"
[sample]
dim = 3
shape = "superellipsoid"
grains = 110
radius = 0.001
boundary = "walls"
height_ratio = 1.12
start_fraction = 0.1
pressure = 1e4
compression_rate = 60
prepared_with = "other_friction"
prepared_friction = 0.05
strain_rate = 6
ramp_time = 0.002
)" + sample +
         R"(
[material]
law = "hertz_elliptic"
density = 2500
young = 3e7
poisson = 0.22
damping = 0.3
)" + rest +
         R"(
[rest]
background_damping = 500
unbalanced_force_ratio = 1e-2
kinetic_to_elastic_energy = 1e-3
[ensemble]
realizations = 1
)";
}

const std::string kCompression = R"(deformation = "uniaxial"
strain = 0.02
records = 3
unload = "stress"
unload_records = 3
)";

Summary run(const Folder& folder, const std::string& text, const std::string& options = "") {
  const std::string file = folder.write("x.toml", text);
  const Output output = program("run " + file + " -o " + (folder / "out") + " " + options);
  EXPECT_EQ(output.code, 0) << output.err;
  if (output.code != 0) return {};
  Summary summary = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(summary));
  return summary;
}

TEST(SampleBox, BitsOfACompressionAreTheSameOnThreadsAndAfterAKill) {
  testing::expect_same_bits(box(kCompression));
}

TEST(SampleBox, BitsOfAProbedAndDroppedSampleTooWhichSpheresFill) {
  testing::expect_same_bits(
      box("filling = \"dropped\"\ndrop_damping = 25\ncompression = \"uniaxial\"\nprobe = "
          "\"both\"\nprobe_strain = 1e-4\n" +
              kCompression,
          "friction = 0.3\nwall_friction = 0.3"),
      "", [](const Summary& summary) {
        const double spheres = number(summary, "sample.gap_spheres");
        EXPECT_GT(spheres, 3);
        EXPECT_EQ(number(summary, "dem.grains"), 110 + spheres);
        // The source's 0.63; small boxes are looser at their walls.
        EXPECT_GT(number(summary, "sample.dropped_solid_fraction"), 0.5);
        EXPECT_LT(number(summary, "sample.dropped_solid_fraction"), 0.7);
        EXPECT_GT(number(summary, "sample.initial_solid_fraction"), 0.55);
        // The lid bears 1e4; p is less where the sides bear less.
        EXPECT_NEAR(number(summary, "sample.initial_pressure") / 1e4, 0.9, 0.2);
      });
}

// Sides that tilt and sides that servos hold, killed while they move.
TEST(SampleBox, BitsOfMovingSidesToo) {
  const std::string friction = "friction = 0.4\nwall_friction = 0.4";
  testing::expect_same_bits(
      box("deformation = \"simple_shear\"\nconstant = \"volume\"\nsides = \"tilting\"\n"
          "strain = 0.1\nrecords = 4\n",
          friction),
      "state_000");
  testing::expect_same_bits(box("deformation = \"axial\"\nstrain = 0.05\nrecords = 4\n", friction),
                            "state_000");
}

TEST(SampleBox, ProbesGiveModuliAndABlockGoesBeside) {
  const Folder folder;
  const Summary summary =
      run(folder,
          box("deformation = \"axial\"\nstrain = 0.1\nrecords = 8\nprobe = \"both\"\n"
              "probe_strain = 3e-5\n[block]\nlaw = \"both\"",
              "friction = 0.4\nwall_friction = 0"),
          "--set ensemble.realizations=2");
  for (const char* state : {"prepared", "first"}) {
    const auto of = [&](const char* key) {
      return number(summary, std::string("moduli.") + state + "." + key);
    };
    // Less stiff than affine motion of all contacts allows, stiffer than the pressure alone.
    EXPECT_GT(of("young"), 1e5);
    EXPECT_LT(of("young"), 3e7);
    EXPECT_GT(of("poisson"), -0.2);
    EXPECT_LT(of("poisson"), 0.5);
    EXPECT_NEAR(of("young"), 9 * of("bulk") * of("shear") / (3 * of("bulk") + of("shear")),
                0.05 * of("young"));
    EXPECT_LT(of("lost"), 0.05);
    EXPECT_LT(of("gained"), 0.05);
    EXPECT_LT(of("nonlinear_share"), 0.2);
    EXPECT_LT(of("asymmetry"), 0.2);
    EXPECT_LE(of("residual_transverse"), of("residual_isotropic") + 1e-12);
    // Smooth walls carry no shear.
    EXPECT_EQ(summary.count(std::string("moduli.") + state + ".g_vh"), 0U);
  }
  const double friction = number(summary, "strength.peak_friction_deg");
  EXPECT_GT(friction, 10);
  EXPECT_LT(friction, 60);
  EXPECT_GE(friction, number(summary, "strength.residual_friction_deg") - 1e-9);
  // A perfectly plastic block at the peak angle ends above grains that soften, and an elastic one
  // far above both.
  EXPECT_GT(number(summary, "block.elastic.end_ratio"), 2);
  EXPECT_GT(number(summary, "block.mohr_coulomb.end_ratio"), 0.8);
  EXPECT_LT(number(summary, "block.mohr_coulomb.rel_l2"), number(summary, "block.elastic.rel_l2"));
  EXPECT_EQ(number(summary, "block.elastic.leaves"), 1);
  EXPECT_THAT(testing::read_text(folder / "out/block.csv"),
              HasSubstr("q_Pa_mohr_coulomb_difference"));
  const std::string page = testing::read_text(folder / "out/report.html");
  EXPECT_THAT(page, HasSubstr("Elastic moduli from small strains"));
  EXPECT_THAT(page, HasSubstr("The grains and a block of finite elements"));
}

// A row of block.csv by the names of its columns.
std::map<std::string, double> block_row(const Folder& folder, int state) {
  std::istringstream lines(testing::read_text(folder / "out/block.csv"));
  std::string heading, line;
  while (std::getline(lines, heading) && heading.starts_with('#')) {
  }
  for (int k = 0; k <= state; ++k) std::getline(lines, line);
  std::map<std::string, double> out;
  std::istringstream names(heading), values(line);
  std::string name, value;
  while (std::getline(names, name, ',') && std::getline(values, value, ',')) {
    out[name] = std::stod(value);
  }
  return out;
}

const std::string kSmall = "--set sample.grains=80 --set output.vtu=false";

// Compression does not tell angles, others are given; and the block goes back, too.
TEST(SampleBox, ABlockGoesBesideCompressionAndUnloading) {
  const Folder folder;
  const Summary summary =
      run(folder,
          box(kCompression +
                  "probe = \"first\"\nprobe_strain = 3e-5\n[block]\nlaw = \"both\"\nangles = "
                  "\"given\"\nfriction_deg = 20\ndilation_deg = 5",
              "friction = 0.4\nwall_friction = 0.4"),
          kSmall + " --set output.report=false");
  // The elastic block rises by M = E (1 - nu)/((1 + nu)(1 - 2 nu)) of the strain, to and fro.
  const double young = number(summary, "moduli.first.young"),
               nu = number(summary, "moduli.first.poisson"),
               modulus = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  const auto first = block_row(folder, 0);
  for (const int state : {3, 6}) {
    const auto row = block_row(folder, state);
    EXPECT_NEAR(row.at("sigma_zz_Pa_elastic") - first.at("sigma_zz_Pa_elastic"),
                modulus * row.at("volumetric_strain_elastic"), 1e-4 * modulus * 0.02);
    EXPECT_NEAR(row.at("volumetric_strain_elastic"), row.at("volumetric_strain"), 1e-7);
  }
  EXPECT_NEAR(
      number(summary, "block.elastic.unloaded_ratio"),
      block_row(folder, 6).at("sigma_zz_Pa_elastic") / block_row(folder, 6).at("sigma_zz_Pa"),
      1e-4);
  // Grains that slid come back stiffer than they went.
  EXPECT_LT(number(summary, "block.elastic.unloading_stiffness"), 0.9);
  EXPECT_EQ(number(summary, "block.mohr_coulomb.friction_deg"), 20);
  EXPECT_EQ(number(summary, "block.mohr_coulomb.dilation_deg"), 5);
  // It flows, with s1 = s3 (1 + sin phi)/(1 - sin phi).
  const auto loaded = block_row(folder, 3);
  const double axial = -loaded.at("sigma_zz_Pa_mohr_coulomb"), p = loaded.at("p_Pa_mohr_coulomb"),
               sine = std::sin(20 * kDegree);
  EXPECT_NEAR(axial / (0.5 * (3 * p - axial)), (1 + sine) / (1 - sine), 1e-3);
}

// At constant volume the plastic block has no dilation and keeps its mean stress, and says so.
TEST(SampleBox, ABlockGoesBesideAShear) {
  const Folder folder;
  const Summary summary =
      run(folder,
          box("precompression = 0.02\ndeformation = \"simple_shear\"\nconstant = \"volume\"\n"
              "strain = 0.1\nrecords = 4\nprobe = \"first\"\nprobe_strain = 3e-5\n[block]\nlaw = "
              "\"both\"",
              "friction = 0.5\nwall_friction = 0.5"),
          kSmall);
  EXPECT_EQ(number(summary, "block.mohr_coulomb.dilation_deg"), 0);
  // sin of the block's angle is tan of the planes' one.
  EXPECT_NEAR(std::sin(number(summary, "block.mohr_coulomb.friction_deg") * kDegree),
              std::tan(number(summary, "strength.peak_friction_deg") * kDegree), 1e-9);
  EXPECT_NEAR(number(summary, "block.elastic.pressure_end_ratio"),
              1 / number(summary, "sample.pressure_ratio"), 1e-6);
  EXPECT_LT(number(summary, "block.mohr_coulomb.rel_l2"), number(summary, "block.elastic.rel_l2"));
  EXPECT_THAT(testing::read_text(folder / "out/report.html"),
              HasSubstr("The volume is held, so the grains show no dilation"));
}

// Three states after the first one tell no residual angle: the plastic block is left out, and why.
TEST(SampleBox, ABlockWithoutItsAngleSaysSo) {
  const Folder folder;
  const Summary summary =
      run(folder, box("deformation = \"axial\"\nstrain = 0.02\nrecords = 3\nprobe = \"first\"\n"
                      "probe_strain = 1e-4\n[block]\nlaw = \"both\"\nangles = \"residual\"",
                      "friction = 0.4\nwall_friction = 0"));
  EXPECT_EQ(summary.count("block.mohr_coulomb.rel_l2"), 0U);
  EXPECT_EQ(summary.count("block.elastic.rel_l2"), 1U);
  EXPECT_THAT(testing::read_text(folder / "out/report.html"),
              HasSubstr("The block of law mohr_coulomb is left out: the grains show no friction "
                        "angle in the last quarter of the strain"));
}

// One box is filled and loaded by two laws from the same places.
TEST(SampleBox, IsFilledOnceForSeveralLaws) {
  const Folder folder;
  const std::string loaded =
      "filling = \"dropped\"\ncompress_to = \"none\"\ndeformation = \"uniaxial\"\nstrain = "
      "0.02\nrecords = 2\n";
  const Summary filled =
      run(folder,
          box("filling = \"dropped\"\ndrop_damping = 25\ncompress_to = \"none\"\n"
              "deformation = \"uniaxial\"\nstrain = 1e-6\nrecords = 1\n",
              "friction = 0.3\nwall_friction = 0.3"),
          "--set output.vtu=false --set output.report=false");
  EXPECT_THAT(std::get<std::string>(filled.at("verdict.sentence")),
              ::testing::StartsWith("A packing "));
  EXPECT_EQ(filled.count("sample.lost_strength"), 0U);
  const std::string files = "--set 'grains.files=[\"" + (folder / "out/snapshots.h5") + "\"]'";
  const auto load = [&](const std::string& law, const std::string& to) {
    const Output output = program("run " + folder.write("y.toml", box(loaded)) + " -o " +
                                  (folder / to) + " " + files + " --set material.law=" + law +
                                  " --set output.report=false --set output.vtu=false");
    EXPECT_EQ(output.code, 0) << output.err;
    return read_summary(folder / (to + "/summary.json"));
  };
  const Summary hertz = load("hertz_elliptic", "a"), penalty = load("penalty", "b");
  EXPECT_EQ(number(hertz, "sample.gap_spheres"), number(penalty, "sample.gap_spheres"));
  EXPECT_EQ(number(hertz, "sample.initial_solid_fraction"),
            number(penalty, "sample.initial_solid_fraction"));
  EXPECT_EQ(number(hertz, "sample.lost_strength"), 0);
  EXPECT_GT(number(hertz, "sample.final_pressure"), 0);
  EXPECT_NE(number(hertz, "sample.final_pressure"), number(penalty, "sample.final_pressure"));
}

TEST(SampleBox, MistakesAreNamed) {
  const std::string text = box(kCompression + "[rve]\nalong = 2\nradii = [2]");
  const auto says = [&](const Overrides& set, const std::string& what) {
    EXPECT_THAT(complaint(text, set), HasSubstr(what));
  };
  EXPECT_EQ(complaint(text), "");
  says({"sample.unload=0.02"},
       "sample.unload: found \"0.02\", allowed: none | strain | stress; a number goes into "
       "sample.unload_strain, sample.unload_stress, sample.unload_records");
  says({"rve.radius=2"}, "rve.radius: unknown key; did you mean rve.radii");
  says({"rve.radii=[2, 9]"}, "rve.radii: found 9, allowed for 110 grains: up to ");
  says({"block.law=elastic"}, "block.law: found \"elastic\", allowed with sample.probe = \"none\"");
  says(
      {"block.law=both", "sample.probe=first"},
      "block.angles: found \"peak\", allowed with sample.deformation = \"uniaxial\": given, "
      "because it "
      "does not show the grains' strength; another test's (strength.*) go into block.friction_deg");
  says({"block.law=both", "sample.probe=first", "block.angles=given", "block.dilation_deg=40"},
       "block.dilation_deg: found 40, allowed: up to block.friction_deg = 30");
  says({"sample.filling=dropped", "sample.boundary=periodic"},
       "sample.filling: found \"dropped\", allowed with sample.boundary = \"periodic\"");
  EXPECT_EQ(complaint(text, {"sample.filling=dropped"}), "");
  says({"sample.filling=dropped", "sample.compression=uniaxial", "sample.base_fraction=0.05",
        "rve.radii=[1]"},
       "sample.base_fraction: found 0.05, allowed: above sample.start_fraction = 0.1");
  says({"sample.probe=first", "rest.background_damping=0"}, "rest.background_damping: found 0");
  says({"grains.files=[\"x.h5\"]"},
       "grains.files: found files of filled boxes, allowed with sample.filling = \"placed\": []");
}

}  // namespace
}  // namespace grainfield::coupling
