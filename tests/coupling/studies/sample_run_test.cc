// Small samples through the real program: states, figures, threads, kills, mistakes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "dem/snapshot/snapshot.h"
#include "tests/coupling/check_scene.h"
#include "tests/coupling/reliability_process.h"
#include "tests/coupling/run_scene.h"
#include "tests/coupling/sample_bits_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::number;
using testing::Output;
using testing::program;

constexpr const char* kDisks = R"(study = "sample"
[sample]
grains = 70
strain = 0.04
strain_rate = 0.3
constant = "stress"
records = 4
[motion]
energy_balance = true
[material]
law = "linear"
normal_damping = 4000
tangential_damping = 2000
[ensemble]
realizations = 2
)";
constexpr const char* kBox = R"(study = "sample"
[sample]
grains = 70
boundary = "walls"
deformation = "axial"
strain = 0.03
strain_rate = 0.2
ramp_time = 0.02
records = 3
[motion]
energy_balance = true
[material]
law = "linear"
normal_damping = 4000
tangential_damping = 2000
[ensemble]
realizations = 1
)";
constexpr const char* kSpheres = R"(study = "sample"
[sample]
dim = 3
shape = "sphere"
grains = 60
radius = 0.001
pressure = 1e5
start_fraction = 0.3
compression_rate = 20
strain = 0.05
strain_rate = 5
constant = "stress"
records = 3
[motion]
energy_balance = true
[material]
law = "hertz"
density = 2500
young = 1e8
damping = 0.3
rolling_friction = 0.1
rolling_stiffness = 2e4
twisting_friction = 1e-5
twisting_stiffness = 0.01
[rest]
background_damping = 200
[ensemble]
realizations = 1
)";

// A table with a header, by column, without its comments.
std::map<std::string, std::vector<double>> read_table(const std::string& file) {
  std::map<std::string, std::vector<double>> out;
  std::vector<std::string> names;
  std::istringstream lines(testing::read_text(file));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    const bool header = names.empty();
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t c = 0; std::getline(cells, cell, ','); ++c) {
      if (header) {
        names.push_back(cell);
      } else {
        out[names.at(c)].push_back(std::stod(cell));
      }
    }
  }
  return out;
}

// The sum over contacts, by hand: in a cell with the branch to the image, in a box to the wall.
Eigen::Matrix3d stress_of(const dem::Snapshot& s) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const dem::Contact& c : s.contacts) {
    dem::Vec3 end = c.point;
    if (c.j >= 0) {
      end = s.grains[static_cast<std::size_t>(c.j)].position;
      for (int a = 0; a < 3; ++a) end += c.image[a] * s.cell.edges.col(a);
    }
    sum += c.force * (end - s.grains[static_cast<std::size_t>(c.i)].position).transpose();
  }
  if (s.cell.periodic[0]) {
    Eigen::Matrix3d edges = s.cell.edges;
    if (s.dim == 2) edges(2, 2) = 1;
    return sum / edges.determinant();
  }
  const auto at = [&](const char* name, int axis) {
    for (const dem::Wall& wall : s.walls) {
      if (wall.name == name) return wall.point[axis];
    }
    ADD_FAILURE() << "no wall " << name;
    return 0.0;
  };
  return sum / ((at("right", 0) - at("left", 0)) * (at("lid", 1) - at("floor", 1)));
}

struct Ran {
  Summary summary;
  std::map<std::string, std::vector<double>> states;  // of the first realization
};

Ran run(const Folder& folder, const char* text, const std::string& options = "") {
  const std::string file = folder.write("x.toml", text);
  const Output output = program("run " + file + " -o " + (folder / "out") + " " + options);
  EXPECT_EQ(output.code, 0) << output.err;
  if (output.code != 0) return {};
  Ran out;
  out.summary = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(out.summary));
  out.states = read_table(folder / "out/states_of_realizations.csv");
  return out;
}

void expect_own_stress(const Folder& folder, const Ran& ran, int dim, int states) {
  const std::string unit = dim == 2 ? "_N/m" : "_Pa";
  for (int k = 0; k < states; ++k) {
    const dem::Snapshot s = dem::read_snapshot(folder / "out/snapshots.h5",
                                               "/realization_000/state_00" + std::to_string(k));
    const Eigen::Matrix3d expected = stress_of(s);
    const double p = -expected.trace() / dim;
    const auto told = [&](const std::string& name) {
      return ran.states.at(name + unit)[static_cast<std::size_t>(k)];
    };
    for (int a = 0; a < dim; ++a) {
      for (int b = 0; b < dim; ++b) {
        EXPECT_NEAR(told(std::string("sigma_") + "xyz"[a] + "xyz"[b]), expected(a, b), 1e-8 * p)
            << k << ": " << a << b;
      }
    }
    EXPECT_NEAR(told("p"), p, 1e-8 * p);
    double q = 0;
    if (dim == 2) {
      const double tau = 0.5 * (expected(0, 1) + expected(1, 0));
      q = 2 * std::hypot(0.5 * (expected(0, 0) - expected(1, 1)), tau);
    } else {
      const Eigen::Matrix3d even = 0.5 * (expected + expected.transpose());
      q = std::sqrt(1.5) * (even + p * Eigen::Matrix3d::Identity()).norm();
    }
    EXPECT_NEAR(told("q"), q, 1e-7 * p);
  }
}

// A sample that liquefies: q/p without load counts nowhere, and the report says so.
TEST(SampleRun, WhatBearsNoLoadIsNoStrength) {
  const Folder folder;
  const Ran ran = run(folder, R"(study = "sample"
[sample]
grains = 70
strain = 0.3
strain_rate = 1
constant = "volume"
pressure = 600
records = 12
[material]
law = "linear"
normal_damping = 4000
tangential_damping = 2000
friction = 0.5
[ensemble]
realizations = 2
)");
  const auto& p = ran.states.at("p_N/m");
  const auto& ratio = ran.states.at("q_over_p");
  const auto& inertia = ran.states.at("inertial_number");
  ASSERT_EQ(p.size(), 26U);
  std::vector<double> losses, peaks, critical;
  double highest = 0;
  for (const std::size_t first : {0, 13}) {
    double peak = 0, tail = 0, loss = 0;
    bool bears_at_the_end = true;
    for (std::size_t k = first; k < first + 13; ++k) {
      const bool bears = p[k] > 0.01 * p[first] && inertia[k] < 0.1;
      if (!bears && loss == 0) loss = ran.states.at("strain")[k];
      if (bears) peak = std::max(peak, ratio[k]);
      highest = std::max(highest, ratio[k]);
      if (k < first + 9) continue;
      tail += ratio[k] / 4;
      bears_at_the_end = bears_at_the_end && bears;
    }
    peaks.push_back(peak);
    if (loss > 0) losses.push_back(loss);
    if (bears_at_the_end) critical.push_back(tail);
  }
  ASSERT_EQ(losses.size(), 1U);
  EXPECT_GT(highest, std::max(peaks[0], peaks[1]));
  EXPECT_EQ(number(ran.summary, "sample.lost_strength"), 0.5);
  EXPECT_NEAR(number(ran.summary, "sample.strain_at_loss"), losses[0], 1e-8);
  EXPECT_NEAR(number(ran.summary, "sample.peak_stress_ratio"), 0.5 * (peaks[0] + peaks[1]), 1e-8);
  ASSERT_FALSE(critical.empty());
  EXPECT_NEAR(
      number(ran.summary, "sample.critical_stress_ratio"),
      std::accumulate(critical.begin(), critical.end(), 0.0) / static_cast<double>(critical.size()),
      1e-8);
  EXPECT_THAT(std::get<std::string>(ran.summary.at("verdict.sentence")),
              HasSubstr("in 1 of 2 realizations."));
}

// No shear, no strength: uniaxial and isotropic compression tell stiffness.
TEST(SampleRun, CompressionHasNoPeak) {
  const Folder folder;
  std::string text = kDisks;
  text.replace(text.find("constant = \"stress\""), 19, "deformation = \"uniaxial\"");
  const Ran ran = run(folder, text.c_str());
  EXPECT_EQ(ran.summary.count("sample.peak_stress_ratio"), 0U);
  EXPECT_EQ(ran.summary.count("sample.critical_stress_ratio"), 0U);
  const double lateral = number(ran.summary, "sample.lateral_stress_ratio");
  const auto& xx = ran.states.at("sigma_xx_N/m");
  const auto& yy = ran.states.at("sigma_yy_N/m");
  EXPECT_NEAR(lateral, 0.5 * (xx[4] / yy[4] + xx[9] / yy[9]), 1e-8);
  EXPECT_GT(lateral, 0.2);
  EXPECT_LT(lateral, 1);
  const std::string sentence = std::get<std::string>(ran.summary.at("verdict.sentence"));
  EXPECT_THAT(sentence, HasSubstr("lateral over axial stress"));
  EXPECT_THAT(sentence, ::testing::Not(HasSubstr("rises")));
}

// What is filled and not loaded has no strength to lose and no modulus.
TEST(SampleRun, APackingThatIsNotLoadedIsCalledSo) {
  const Folder folder;
  std::string text = kDisks;
  text.replace(text.find("strain = 0.04"), 13, "strain = 1e-6");
  text.replace(text.find("records = 4"), 11, "records = 1");
  const Ran ran = run(folder, text.c_str());
  const std::string sentence = std::get<std::string>(ran.summary.at("verdict.sentence"));
  EXPECT_THAT(sentence, ::testing::StartsWith("A packing at rest, not loaded: solid fraction 0."));
  EXPECT_THAT(sentence, ::testing::EndsWith(" N/m, 2 realizations."));
  for (const char* key : {"sample.lost_strength", "sample.peak_stress_ratio",
                          "sample.secant_modulus", "strength.peak_friction_angle_deg"}) {
    EXPECT_EQ(ran.summary.count(key), 0U) << key;
  }
  EXPECT_GT(number(ran.summary, "sample.initial_pressure"), 0);
}

TEST(SampleRun, DisksInACell) {
  const Folder folder;
  const Ran ran = run(folder, kDisks);
  ASSERT_FALSE(ran.states.empty());
  expect_own_stress(folder, ran, 2, 5);
  EXPECT_EQ(ran.states.at("state").size(), 10U);
  EXPECT_NEAR(ran.states.at("strain").back(), 0.04, 2e-5);  // whole steps
  EXPECT_NEAR(number(ran.summary, "sample.initial_pressure"), 1e4, 30);
  EXPECT_LT(number(ran.summary, "sample.energy_balance_error.most"), 1e-3);
  EXPECT_LT(number(ran.summary, "sample.stress_rms_error"), 0.01);
  // The normal stress is held, so the cell's height follows: no edge along x moves.
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_NEAR(ran.states.at("sigma_yy_N/m")[k] + ran.states.at("p_motion_N/m")[k], -1e4, 500);
    EXPECT_NEAR(ran.states.at("volumetric_strain")[k], ran.states.at("strain_yy")[k], 1e-9);
  }
  // The work is that of the shear stress and of the held one; the trapezoid is a coarse integral.
  const double work = ran.states.at("work_J")[4], lost = ran.states.at("dissipated_J")[4];
  EXPECT_GT(work, 0);
  EXPECT_GT(lost, 0.5 * work);
  const auto mean = read_table(folder / "out/states.csv");
  const auto& q = ran.states.at("q_over_p");
  EXPECT_NEAR(mean.at("q_over_p")[2], 0.5 * (q[2] + q[7]), 1e-8);
  EXPECT_NEAR(mean.at("q_over_p_error")[2], 0.5 * std::fabs(q[2] - q[7]), 1e-8);
  EXPECT_NEAR(number(ran.summary, "sample.peak_stress_ratio"),
              0.5 * (*std::max_element(q.begin(), q.begin() + 5) +
                     *std::max_element(q.begin() + 5, q.end())),
              1e-8);
  for (const char* name :
       {"report.html", "states/grains_state_004.vtu", "states/contacts_state_000.vtu", "grains.pvd",
        "snapshots.h5", "case.toml"}) {
    EXPECT_TRUE(testing::fs::exists(folder / ("out/" + std::string(name)))) << name;
  }
  EXPECT_FALSE(testing::fs::exists(folder / "out/profiles.csv"));
  const std::string page = testing::read_text(folder / "out/report.html");
  EXPECT_THAT(page, HasSubstr("70 disks in a periodic cell"));
  EXPECT_THAT(page, ::testing::Not(HasSubstr("could not be drawn")));
}

TEST(SampleRun, DisksBetweenWalls) {
  const Folder folder;
  const Ran ran = run(folder, kBox, "--set output.report=false --set output.vtu=false");
  ASSERT_FALSE(ran.states.empty());
  expect_own_stress(folder, ran, 2, 4);
  EXPECT_NEAR(ran.states.at("strain_yy").back(), std::log(1 - 0.03), 1e-4);
  // The sides are held, so the lid bears more.
  EXPECT_LT(ran.states.at("sigma_yy_N/m").back(), 1.05 * ran.states.at("sigma_xx_N/m").back());
  EXPECT_LT(number(ran.summary, "sample.energy_balance_error"), 1e-3);
  EXPECT_LT(number(ran.summary, "sample.stress_rms_error"), 0.03);
}

TEST(SampleRun, SpheresInACell) {
  const Folder folder;
  const Ran ran = run(folder, kSpheres);
  ASSERT_FALSE(ran.states.empty());
  expect_own_stress(folder, ran, 3, 4);
  EXPECT_LT(number(ran.summary, "sample.energy_balance_error"), 1e-3);
  EXPECT_GT(ran.states.at("sigma_xz_Pa").back(), 0);
  EXPECT_THAT(testing::read_text(folder / "out/report.html"), HasSubstr("cuts out of the spheres"));
  EXPECT_THAT(testing::read_text(folder / "out/states/grains_state_003.vtu"),
              HasSubstr("rotation"));
}

class SampleBits : public ::testing::TestWithParam<const char*> {};

TEST_P(SampleBits, AreTheSameOnThreadsAndAfterAKill) { testing::expect_same_bits(GetParam()); }

INSTANTIATE_TEST_SUITE_P(All, SampleBits, ::testing::Values(kDisks, kBox, kSpheres));

TEST(SampleRun, VariantsStandBesideEachOther) {
  const Folder folder;
  const std::string file = folder.write(
      "x.toml", std::string(kDisks) +
                    "[sweep]\nkey = \"variant\"\nvalues = [\"volume\", \"stress\"]\n"
                    "[variant.volume.sample]\nconstant = \"volume\"\n[variant.stress]\n");
  const Output output = program("run " + file + " -o " + (folder / "out") + " --threads 2");
  ASSERT_EQ(output.code, 0) << output.err;
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NEAR(number(s, "sample.volumetric_strain.volume"), 0, 1e-9);
  EXPECT_NE(number(s, "sample.volumetric_strain.stress"), 0);
  EXPECT_TRUE(testing::fs::exists(folder / "out/stress/states.csv"));
  // One member has no curve of its volume, which it imposes.
  const std::string page = testing::read_text(folder / "out/report.html");
  EXPECT_THAT(page, HasSubstr("All members"));
  EXPECT_THAT(page, Not(HasSubstr("No picture")));
}

TEST(SampleRun, WhatDoesNotHoldIsRefusedInOneLine) {
  const Folder folder;
  const auto refused = [&](const std::string& text, const std::string& sets) {
    const std::string file = folder.write("x.toml", text);
    for (const char* command : {"check ", "run "}) {
      const Output output =
          program(command + file + sets + (*command == 'r' ? " -o " + (folder / "out") : ""));
      EXPECT_EQ(output.code, 2) << command << sets << output.err;
      EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
      if (*command == 'r') return output.err;
    }
    return std::string();
  };
  EXPECT_THAT(refused(kDisks, " --set material.twisting_friction=0.1"),
              HasSubstr("material.twisting_friction: found 0.1, allowed: only in three dimensions: "
                        "0 to 1000; the grains of study = \"sample\" are in 2D with sample.dim = "
                        "2"));
  EXPECT_THAT(refused(kDisks, " --set sample.pressure=0"),
              HasSubstr("sample.pressure: found 0: a servo without a target"));
}

// The same without starting the program.
TEST(SampleRun, Mistakes) {
  const auto says = [](const char* text, const Overrides& set, const char* what) {
    EXPECT_THAT(complaint(text, set), HasSubstr(what)) << set.front();
  };
  EXPECT_EQ(complaint(kDisks), "");
  EXPECT_EQ(complaint(kBox), "");
  EXPECT_EQ(complaint(kSpheres), "");
  says(kDisks, {"material.law=hertz"},
       "material.law: found \"hertz\", allowed: overlap_area | energy | linear | penalty; only in "
       "three "
       "dimensions: hertz, hertz_elliptic");
  says(kSpheres, {"material.law=energy"},
       "material.law: found \"energy\", allowed: linear | hertz | penalty | hertz_elliptic; only "
       "in two dimensions: "
       "overlap_area, energy; the grains of study = \"sample\" are in 3D with sample.dim = 3");
  says(kDisks, {"sample.shape=sphere"}, "sample.shape: found \"sphere\", allowed: disk");
  says(kSpheres, {"sample.shape=disk"}, "sample.shape: found \"disk\", allowed: sphere");
  says(kSpheres, {"motion.integrator=gear"}, "motion.integrator: found \"gear\"");
  says(kSpheres, {"sample.start_fraction=0.4"}, "sample.start_fraction: found 0.4");
  says(kBox, {"sample.strain_rate=1e5"}, "sample.strain_rate: found 100000 1/s: a wall would pass");
  says(kBox, {"sample.compression_rate=1e5"}, "sample.compression_rate: found 100000 1/s: a wall");
  says(kDisks, {"sample.strain_rate=1e5"}, "sample.strain_rate: found 100000 1/s");
  says(kBox, {"sample.compress_to=strain"}, "sample.compress_to: found \"strain\"");
  says(kBox, {"sample.compression=uniaxial"}, "sample.compression: found \"uniaxial\"");
  says(kDisks, {"sample.pressure=1e9"}, "sample.pressure: found 1e+09, allowed: up to");
  says(kDisks, {"sample.grains=4"}, "sample.grains: found 4");
  says(kDisks, {"sample.records=0"}, "sample.records: found 0, allowed: 1 to 999");
  says(kDisks, {"sample.dim=4"}, "sample.dim: found 4, allowed: 2 to 3");
  says(kDisks, {"sample.boundry=walls"}, "unknown key; did you mean sample.boundary");
  says(kDisks, {"sample.shape=rand1", "sample.corners_min=9"}, "sample.corners_max: found 8");
  says(kDisks,
       {"material.rolling_friction=0.1", "material.rolling_stiffness=1e6", "sample.shape=rand1",
        "material.law=energy"},
       "material.rolling_friction: found above 0, allowed for polygons: 0");
  says(kSpheres, {"material.twisting_stiffness=0"}, "twisting_friction");
  const Overrides superellipsoids{"sample.shape=superellipsoid",  "sample.start_fraction=0.1",
                                  "material.law=hertz_elliptic",  "material.rolling_friction=0",
                                  "material.twisting_friction=0", "sample.grains=90"};
  const auto with = [&](const char* set) {
    Overrides all = superellipsoids;
    all.insert(all.begin(), set);
    return all;
  };
  for (const char* key : {"sample.exponent_min", "sample.exponent_max"}) {
    for (const char* value : {"0", "2", "-1"}) {
      says(kSpheres, with(fmt::format("{}={}", key, value).c_str()),
           fmt::format("{}: found {}, allowed: 0.1 to 1.9", key, value).c_str());
    }
  }
  says(kSpheres, with("sample.axis_min=0"), "sample.axis_min: found 0, allowed: 0.05 to 20");
  says(kSpheres, with("sample.axis_max=-1"), "sample.axis_max: found -1, allowed: 0.05 to 20");
  says(kSpheres, with("sample.radius=0"), "sample.radius: found 0, allowed: ");
  says(kSpheres, with("material.poisson=0.6"),
       "material.poisson: found 0.6, allowed: -0.999 to 0.5");
  says(kSpheres, with("material.poisson=-1"), "material.poisson: found -1, allowed: -0.999 to 0.5");
  EXPECT_EQ(complaint(kSpheres, with("material.poisson=-0.995")), "");
  says(kBox, {"sample.deformation=uniaxial", "sample.strain=0.8"},
       "sample.strain: found 0.8, allowed: up to ");
  says(kSpheres, {"motion.integrator=runge_kutta"},
       "motion.integrator: found \"runge_kutta\", allowed for grains of this shape (sphere): "
       "verlet");
  EXPECT_EQ(complaint(kSpheres, with("motion.integrator=runge_kutta")), "");
  says(kDisks, {"material.gravity=1"}, "has no meaning for study = \"sample\"");
}

}  // namespace
}  // namespace grainfield::coupling
