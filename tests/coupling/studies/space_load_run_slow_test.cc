// Layers of spheres under a point load through the real program: figures, fields, threads, kills,
// mistakes; and what of the analysis can be told by itself.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "continuum/model.h"
#include "coupling/averaging/average.h"
#include "coupling/averaging/base_space.h"
#include "coupling/averaging/layer.h"
#include "coupling/compare/smooth.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "coupling/store/field_io.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/snapshot.h"
#include "tests/coupling/check_scene.h"
#include "tests/coupling/reliability_process.h"
#include "tests/coupling/run_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using testing::Folder;
using ::testing::HasSubstr;
using testing::number;
using testing::Output;
using testing::program;

// Some 260 spheres, done in a few seconds.
constexpr const char* kLayer = R"(study = "point-load"
[packing]
dim = 3
kind = "random"
sizes = "uniform"
radius_min = 0.0045
radius_max = 0.0055
width = 0.08
depth = 0.036
[material]
law = "hertz"
density = 2500
young = 1e7
damping = 0.3
[rest]
background_damping = 60
[load]
weights = 1
ramp_time = 0.02
probe_strain = 1e-6
[ensemble]
realizations = 2
[average]
methods = ["coarse_graining"]
width_diameters = 1
depths = [0.5]
points = 11
map_columns = 9
map_rows = 5
[compare]
models = ["boussinesq", "layer", "rough", "transverse_half_space"]
[model.rough]
name = "layer"
base = "rough"
[model.transverse_half_space]
E_h = 1
E_v = 2
)";

// One run for all tests of its results.
const Folder& results() {
  static const Folder folder;
  static const bool kDone = [] {
    const std::string file = folder.write("x.toml", kLayer);
    const Output output = program("run " + file + " -o " + (folder / "out"));
    EXPECT_EQ(output.code, 0) << output.err;
    return true;
  }();
  EXPECT_TRUE(kDone);
  return folder;
}

dem::Snapshot state(const char* name) {
  return dem::read_snapshot(results() / "out/snapshots.h5",
                            std::string("/realization_000/") + name);
}

TEST(SpaceLoadRun, LeavesFiguresFieldsAndAReport) {
  const Folder& folder = results();
  const Summary summary = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(summary));
  EXPECT_NEAR(number(summary, "response.total_over_load"), 1, 0.01);
  EXPECT_NEAR(number(summary, "base.weight_ratio"), 1, 1e-4);
  EXPECT_NEAR(number(summary, "load.force_over_weight"), 1, 1e-12);
  EXPECT_GT(number(summary, "response.within_over_load"), 0.5);
  EXPECT_LT(number(summary, "response.within_over_load"), 1.2);
  const double h = number(summary, "layer.depth");
  EXPECT_NEAR(number(summary, "layer.F_over_h2") * h * h, number(summary, "load.force"), 1e-12);
  EXPECT_NEAR(number(summary, "response.peak") / number(summary, "layer.F_over_h2"),
              number(summary, "response.peak_over_F_per_h"), 1e-9);
  EXPECT_EQ(summary.count("response.integral"), 0U);
  const std::string page = testing::read_text(folder / "out/report.html");
  for (const char* title : {"Response by radius", "Pressure on the base", "Vertical cut"}) {
    EXPECT_THAT(page, HasSubstr(title));
  }
  const std::string csv = testing::read_text(folder / "out/profiles.csv");
  EXPECT_THAT(csv, HasSubstr("-sigma_zz"));
  EXPECT_THAT(csv, HasSubstr("simulation_Pa"));
  for (const char* name : {"unloaded", "loaded"}) {
    EXPECT_TRUE(
        std::filesystem::exists(folder / (std::string("out/states/grains_") + name + ".vtu")))
        << name;
  }
}

// The layers' own moduli, measured before the load, are a model beside the case's: their means are
// its constants, and nothing of it is fitted.
TEST(SpaceLoadRun, MeasuredModuliPredictTheResponse) {
  const Summary summary = read_summary(results() / "out/summary.json");
  continuum::Settings settings{{"F", fmt::format("{:.17g}", number(summary, "load.force"))},
                               {"h", fmt::format("{:.17g}", number(summary, "layer.depth"))},
                               {"base", "rough"}};
  for (const auto& [key, parameter] : std::map<std::string, std::string>{
           {"e_h", "E_h"}, {"e_v", "E_v"}, {"nu_h", "nu_h"}, {"nu_v", "nu_v"}, {"g_v", "G_v"}}) {
    const double mean = number(summary, "predicted." + key);
    EXPECT_GT(mean, 0) << key;
    EXPECT_GT(number(summary, "predicted." + key + ".standard_error"), 0) << key;
    settings[parameter] = fmt::format("{:.6g}", mean);
  }
  // Softer than the grains' material by their overlaps, and not by orders of magnitude more.
  EXPECT_LT(number(summary, "predicted.e_v"), 0.5 * 1e7);
  EXPECT_GT(number(summary, "predicted.e_v"), 1e-3 * 1e7);
  EXPECT_LT(number(summary, "predicted.nonlinear_share"), 0.3);
  EXPECT_LT(number(summary, "predicted.residual"), 0.5);
  for (const char* model : {"predicted", "predicted_smooth"}) {
    EXPECT_GT(number(summary, std::string("compare.") + model + ".rel_l2"), 0) << model;
  }
  // Its field in the cut is the closed form at the settings that the summary tells.
  const Field field = read_field(results() / "out/fields.h5", "model_predicted");
  const auto model = continuum::make_model("transverse_layer", settings);
  const Eigen::VectorXd expected = model->stress(field.points).col(2);
  const Eigen::VectorXd& found = field.find("sigma_zz")->value;
  double most = 0;
  for (Eigen::Index k = 0; k < found.size(); ++k) {
    if (std::isfinite(expected[k]) && std::isfinite(found[k])) {
      EXPECT_NEAR(found[k], expected[k], 1e-6 * std::fabs(expected[k]) + 1e-9);
      most = std::max(most, -found[k]);
    }
  }
  EXPECT_GT(most, 0);
  EXPECT_GT(number(summary, "predicted.peak_over_F_per_h2"), 0.2);
  EXPECT_LT(number(summary, "predicted.peak_over_F_per_h2"), 1.2);
  EXPECT_GT(number(summary, "predicted.peak_over_F_per_h2.standard_error"), 0);
  EXPECT_THAT(testing::read_text(results() / "out/report.html"),
              HasSubstr("Moduli by uniform strain of the layers"));
}

// The vertical force of the response is F through every horizontal cut below the load, and the
// smeared base response holds it as well.
TEST(SpaceLoadRun, TheResponseCarriesTheLoadThroughEveryCut) {
  const dem::Snapshot unloaded = state("unloaded"), loaded = state("loaded");
  const double force = -dem::total_applied_force(loaded).z();
  const LayerFrame frame = layer_frame(unloaded, loaded.loaded_grain);
  EXPECT_NEAR(frame.width(), 0.08, 1e-12);
  AverageOptions options;
  options.width = 0.01;
  options.quantities = {"sigma"};
  options.least_grains = 0;
  constexpr int kPlaces = 24;
  const double step = frame.width() / kPlaces;
  const auto cut = [&](double z) {
    return box_points({frame.left + step / 2, frame.front + step / 2, z},
                      {frame.right - step / 2, frame.back - step / 2, z}, kPlaces, kPlaces, 1);
  };
  for (const double share : {0.35, 0.45, 0.55}) {  // the kernel does not reach the load
    const double z = frame.floor + share * frame.depth();
    const Field field = response(unloaded, loaded, cut(z), options);
    const double carried = -field.find("sigma_zz")->value.sum() * step * step;
    EXPECT_NEAR(carried, force, 0.01 * force) << share;
  }
  const auto kernel = make_kernel("lucy", 0.01, 3);
  const Field base = base_stress_response(unloaded, loaded, cut(frame.floor).leftCols(2), *kernel);
  EXPECT_NEAR(-base.find("sigma_zz")->value.sum() * step * step, force, 0.01 * force);
  EXPECT_NEAR((dem::base_force(loaded) - dem::base_force(unloaded)).z(), force, 0.01 * force);
}

// div sigma of the response is 0 away from the load and the base: against the sizes of the
// derivatives that cancel.
TEST(SpaceLoadRun, TheResponseIsInEquilibrium) {
  const dem::Snapshot unloaded = state("unloaded"), loaded = state("loaded");
  const LayerFrame frame = layer_frame(unloaded, loaded.loaded_grain);
  AverageOptions options;
  options.width = 0.006;
  options.quantities = {"sigma"};
  options.least_grains = 0;
  const double e = 0.03 * options.width;
  const char* kNames[3][3] = {{"sigma_xx", "sigma_xy", "sigma_xz"},
                              {"sigma_yx", "sigma_yy", "sigma_yz"},
                              {"sigma_zx", "sigma_zy", "sigma_zz"}};
  // Not nearer to the surface or the floor than the kernel reaches.
  Eigen::MatrixXd at(4, 3);
  const double middle = frame.floor + 0.5 * frame.depth();
  at << frame.load_x, frame.load_y, middle, frame.load_x + 0.004, frame.load_y, middle,
      frame.load_x, frame.load_y - 0.006, middle + 0.002, frame.load_x - 0.01, frame.load_y + 0.003,
      middle - 0.002;
  Eigen::MatrixXd divergence = Eigen::MatrixXd::Zero(4, 3), sizes = divergence;
  for (int b = 0; b < 3; ++b) {
    const auto shifted = [&](double way) {
      Eigen::MatrixXd points = at;
      points.col(b).array() += way;
      return response(unloaded, loaded, points, options);
    };
    const Field up = shifted(e), down = shifted(-e), up2 = shifted(2 * e), down2 = shifted(-2 * e);
    for (int a = 0; a < 3; ++a) {
      const auto of = [&](const Field& f) { return f.find(kNames[a][b])->value; };
      const Eigen::VectorXd slope = (8 * (of(up) - of(down)) - (of(up2) - of(down2))) / (12 * e);
      divergence.col(a) += slope;
      sizes.col(a) += slope.cwiseAbs();
    }
  }
  EXPECT_LT(divergence.norm(), 1e-2 * sizes.norm());
}

TEST(SpaceLoadRun, SameFilesOnAnyThreadsAndAfterAKill) {
  const Folder folder;
  const std::string file = folder.write("x.toml", kLayer);
  ASSERT_EQ(program("run " + file + " -o " + (folder / "one") + " --threads 1").code, 0);
  ASSERT_EQ(program("run " + file + " -o " + (folder / "two") + " --threads 2").code, 0);
  // Killed in the midst of it, and resumed.
  const Output killed =
      program("run " + file + " -o " + (folder / "three") + " --threads 2 --checkpoint-seconds 0.2",
              "timeout -s KILL 1.5");
  EXPECT_NE(killed.code, 0);
  ASSERT_EQ(program("run " + file + " -o " + (folder / "three") + " --threads 1 --resume").code, 0);
  const auto one = testing::contents(folder / "one");
  for (const char* other : {"two", "three"}) {
    const auto found = testing::contents(folder / other);
    for (const char* name : {"summary.json", "profiles.csv", "fields.h5", "snapshots.h5"}) {
      EXPECT_TRUE(one.at(name) == found.at(name)) << other << " " << name;
    }
  }
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = kLayer;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// A load of hundreds of weights goes through the layer: the verdict says that no model applies.
TEST(SpaceLoadRun, ALoadThatRearrangesGrainsIsADoubt) {
  const Folder folder;
  const std::string file = folder.write("x.toml", with("weights = 1\n", "weights = 300\n"));
  const Output output =
      program("run " + file + " --set load.probe_strain=0 -o " + (folder / "out"));
  EXPECT_EQ(output.code, 0) << output.err;
  const std::string doubts =
      std::get<std::string>(read_summary(folder / "out/summary.json").at("verdict.doubts"));
  EXPECT_THAT(doubts,
              HasSubstr("grains rearrange, so the models do not apply. Lower load.weights."));
  const Summary small = read_summary(results() / "out/summary.json");
  const auto at = small.find("verdict.doubts");
  if (at != small.end()) {
    EXPECT_THAT(std::get<std::string>(at->second), ::testing::Not(HasSubstr("rearrange")));
  }
}

TEST(SpaceLoadRun, RefusesWhatDoesNotHoldInSpace) {
  EXPECT_EQ(complaint(kLayer), "");
  EXPECT_THAT(complaint(with("kind = \"random\"", "kind = \"layered\"")),
              HasSubstr("packing.kind: found \"layered\", allowed: close_packed | random"));
  EXPECT_THAT(complaint(with("dim = 3\n", "")), HasSubstr("only in three dimensions"));
  EXPECT_THAT(complaint(with("law = \"hertz\"", "law = \"overlap_area\"")),
              HasSubstr("material.law: found \"overlap_area\""));
  EXPECT_THAT(
      complaint(with("[load]\n", "[load]\nforce = 5\n")),
      HasSubstr("load.force: found 5 beside load.weights = 1, the load in weights of a sphere; "
                "allowed: one of both; to give N, add --set load.weights=0"));
  EXPECT_EQ(complaint(with("[load]\n", "[load]\nmethod = \"newton\"\n")), "");
  const Folder folder;
  const std::string disk = folder.write("x.toml", with("[load]\n", "[load]\nradius = 0.02\n"));
  EXPECT_THAT(program("check " + disk).err,
              HasSubstr("load.radius: found 0.02: the models beside"));
  EXPECT_THAT(complaint(with("\"boussinesq\", ", "\"flamant\", ")), HasSubstr("compare.models"));
  EXPECT_THAT(
      complaint(with("[packing]\n", "[packing]\nsides = \"walls\"\n")),
      HasSubstr("load.probe_strain: found 1e-06 with packing.sides = \"walls\", allowed: 0"));
  EXPECT_THAT(complaint(with("\"rough\", ", "\"predicted\", ") +
                        "[model.predicted]\nname = \"boussinesq\"\n"),
              HasSubstr("compare.models: found \"predicted\" with load.probe_strain"));
  EXPECT_THAT(complaint(with("young = 1e7", "young = 70")),
              HasSubstr("material.young: found 70 Pa, allowed: at least"));
  EXPECT_THAT(complaint(with("width = 0.08", "width = 0.02")),
              HasSubstr("packing.width: found 0.02"));
  EXPECT_THAT(complaint("study = \"point-load\"\n[load]\nweights = 2\n"),
              HasSubstr("load.weights: found 2"));
  const std::string space =
      "study = \"point-load\"\n[packing]\ndim = 3\nkind = \"random\"\n[material]\nlaw = "
      "\"hertz\"\n";
  EXPECT_THAT(complaint(space + "[fit]\nmodels = [\"flamant\"]\n"),
              HasSubstr("x.toml:8: fit.models: found \"flamant\" with packing.dim = 3"));
  EXPECT_THAT(
      complaint(space + "[grains]\nfiles = [\"a.h5\"]\n[compare]\nmodels = [\"boussinesq\"]\n"),
      HasSubstr("x.toml:8: grains.files: found 1 with packing.dim = 3, allowed: none"));
}

TEST(BaseStress, HoldsTheForceAndKnowsImages) {
  dem::Snapshot s;
  s.dim = 3;
  s.cell.periodic = {true, true, false};
  s.cell.edges = Eigen::Vector3d(1, 1, 0).asDiagonal();
  s.walls.push_back({"floor", {0, 0, 0}, {0, 0, 1}});
  s.grains.resize(1);
  s.grains[0].radius = 0.1;
  s.grains[0].position = {0.02, 0.5, 0.1};
  dem::Contact c;
  c.i = 0;
  c.j = -1;
  c.point = {0.02, 0.5, 0};
  c.force = {0.3, -0.2, 2};
  s.contacts.push_back(c);
  const auto kernel = make_kernel("lucy", 0.1, 3);
  Eigen::MatrixXd places(3, 2);
  places << 0.05, 0.5, 0.95, 0.5, 1.05, 1.5;  // the second one sees it across the cell's end
  const Field field = base_stress(s, places, *kernel);
  const Eigen::VectorXd& zz = field.find("sigma_zz")->value;
  EXPECT_NEAR(zz[0], -2 * seen_from_above(*kernel, 0.03), 1e-12);
  EXPECT_NEAR(zz[1], -2 * seen_from_above(*kernel, 0.07), 1e-12);
  EXPECT_NEAR(zz[2], zz[0], 1e-9);
  EXPECT_NEAR(field.find("sigma_xz")->value[0], -0.3 * seen_from_above(*kernel, 0.03), 1e-12);
  EXPECT_NEAR(field.find("sigma_yz")->value[0], 0.2 * seen_from_above(*kernel, 0.03), 1e-12);
  EXPECT_THROW(base_stress(s, places, *make_kernel("lucy", 0.1, 2)), std::invalid_argument);
}

TEST(BaseStress, KernelsSeenFromAboveHaveIntegralOne) {
  for (const char* name : {"lucy", "gaussian", "heaviside"}) {
    const auto kernel = make_kernel(name, 0.3, 3);
    constexpr int kRings = 20000;
    double sum = 0;
    for (int k = 0; k < kRings; ++k) {
      const double step = kernel->range() / kRings, r = (k + 0.5) * step;
      sum += 2 * std::numbers::pi * r * step * seen_from_above(*kernel, r);
    }
    EXPECT_NEAR(sum, 1, 1e-4) << name;
  }
}

TEST(BaseStress, RingsAverageOverTheAngle) {
  const Eigen::VectorXd radii = Eigen::VectorXd::LinSpaced(5, 0, 2);
  const RingPlaces rings = ring_places({1, -2}, radii, 0.1);
  Eigen::VectorXd values(rings.places.rows());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const double x = rings.places(k, 0) - 1, y = rings.places(k, 1) + 2;
    values[k] = 3 + x + x * x;  // mean over the ring 3 + r^2/2
    EXPECT_LE(std::hypot(x, y), 2 + 1e-12);
  }
  const Eigen::VectorXd means = ring_means(rings, values);
  for (Eigen::Index k = 0; k < radii.size(); ++k) {
    EXPECT_NEAR(means[k], 3 + radii[k] * radii[k] / 2, 1e-12);
  }
}

// What the models of the case give through the analysis is what their registry says at their own
// constants: smoothed with a kernel that is narrow against the depth they are themselves.
TEST(SmoothSpace, ModelsOnTheBaseAreThemselves) {
  Eigen::MatrixXd points(3, 3);
  points << 0, 0, -1, 0.3, 0, -1, 0.7, 0.7, -1;
  const auto narrow = make_kernel("lucy", 0.01, 3), wide = make_kernel("lucy", 0.4, 3);
  for (const char* base : {"smooth", "rough"}) {
    const ModelChoice choice{"layer", "layer", {{"base", base}}};
    const RunFacts facts{2, 1, 3, 0.5, "", {}};
    const Evaluation e = evaluate_model(choice, facts,
                                        {{points, Smoothing::marginal, narrow.get()},
                                         {points, Smoothing::none, nullptr},
                                         {points, Smoothing::marginal, wide.get()}});
    EXPECT_LT((e.stresses[0] - e.stresses[1]).norm(), 2e-3 * e.stresses[1].norm()) << base;
    // A wide one lowers the peak, and no layer of zeros is smeared in from below.
    EXPECT_GT(e.stresses[2](0, 2), e.stresses[1](0, 2)) << base;
    EXPECT_LT(e.stresses[2](0, 2), 0.6 * e.stresses[1](0, 2)) << base;
  }
}

TEST(SmoothSpace, OverThePlaneLeavesALinearFieldAsItIs) {
  const StressFunction linear = [](const Eigen::MatrixXd& p) -> Eigen::MatrixXd {
    Eigen::MatrixXd s(p.rows(), 6);
    s << p, 2 * p.col(0) - p.col(2), p.col(1) + p.col(2), 3 * p.col(2);
    return s;
  };
  const Eigen::MatrixXd points = Eigen::RowVector3d(0.3, -0.2, -0.5);
  for (const char* name : {"lucy", "gaussian", "heaviside"}) {
    EXPECT_TRUE(nodes_over_plane(points, *make_kernel(name, 0.05, 3))
                    .of(linear)
                    .isApprox(linear(points), 1e-12))
        << name;
  }
  EXPECT_THROW(nodes_over_plane(points, *make_kernel("lucy", 1)), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::coupling
