// Cones through the real program: figures, fields, balance, threads, mistakes; and what is measured
// of a cone that is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <sstream>
#include <vector>

#include "coupling/averaging/base.h"
#include "coupling/averaging/cone.h"
#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "coupling/specimen/cone_windows.h"
#include "coupling/store/field_io.h"
#include "dem/random/random.h"
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

// Three hundred spheres, done in a few seconds.
constexpr const char* kCone = R"(study = "cone"
[cone]
source = "point"
grains = 300
radius = 0.002
polydispersity = 0.2
mouth = 0.006
rate = 3000
drop = 0.008
speed = 0.3
floor_radius = 0.045
[material]
law = "hertz"
density = 2500
young = 3e5
damping = 0.3
friction = 0.5
rolling_stiffness = 10
rolling_damping = 0.001
rolling_friction = 0.3
[rest]
background_damping = 60
unbalanced_force_ratio = 1e-4
kinetic_to_elastic_energy = 1e-6
[ensemble]
realizations = 2
[average]
methods = ["coarse_graining"]
width_diameters = 1
points = 21
map_columns = 11
map_rows = 7
[heap]
heights = [0.3]
centre = 0.2
shoulder_from = 0.2
shoulder_to = 0.6
[compare]
models = ["cone_osl", "cone_bcc"]
)";

// One run for all tests of its results.
class ConeRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    const Output run = program("run " + folder_->write("c.toml", kCone) + " -o " +
                               (*folder_ / "out") + " 2> " + (*folder_ / "err"));
    ASSERT_EQ(run.code, 0) << testing::read_text(*folder_ / "err");
    summary_ = read_summary(*folder_ / "out/summary.json");
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string out(const std::string& name) { return *folder_ / ("out/" + name); }
  static double of(const std::string& key) { return number(summary_, key); }

  static Folder* folder_;
  static Summary summary_;
};
Folder* ConeRun::folder_ = nullptr;
Summary ConeRun::summary_;

TEST_F(ConeRun, CarriesItsWeightOnItsBase) {
  EXPECT_NEAR(of("base.weight_ratio"), 1, 1e-4);
  // Rings about the axis miss only the strays beyond them.
  EXPECT_NEAR(of("cone.base_over_weight"), 1, 0.06);
  EXPECT_LT(of("average.coarse_graining.balance_rms"), 2e-3);
  EXPECT_EQ(of("dem.grains") + of("cone.grains_lost"), 300);
  // The mean pressure over the foot is the weight over its area: h/3 of a cone, more of a dome.
  EXPECT_GT(of("dip.shoulder"), 1.0 / 3);
  EXPECT_LT(of("dip.shoulder"), 1);
  EXPECT_NEAR(of("cone.height") / of("cone.foot"),
              std::tan(of("cone.repose_deg") * std::numbers::pi / 180),
              0.35 * of("cone.height") / of("cone.foot"));
}

TEST_F(ConeRun, PushesTheFloorOutwards) {
  const dem::Snapshot pile = dem::read_snapshot(out("snapshots.h5"), "/realization_000/pile");
  const ConeFrame frame = cone_frame(pile);
  double inwards = 0;
  for (const BaseSupport& f : base_supports(pile)) {
    const Eigen::Vector2d away = f.point.head<2>() - Eigen::Vector2d(frame.apex_x, frame.apex_y);
    inwards -= f.force.head<2>().dot(away.normalized());
  }
  EXPECT_GT(inwards, 0);
  EXPECT_GT(of("base.largest_shear"), 0.01);
  EXPECT_LT(of("base.largest_shear"), of("base.largest_pressure"));
}

TEST_F(ConeRun, LeavesFieldsThatReadersTake) {
  for (const char* name : {"base", "base_rings", "coarse_graining_inside",
                           "coarse_graining_height_0.3", "model_cone_osl", "model_cone_bcc"}) {
    const Field field = read_field(out("fields.h5"), name);
    EXPECT_EQ(field.points.cols(), 3) << name;
    ASSERT_NE(field.find("sigma_zz"), nullptr) << name;
  }
  const Field rings = read_field(out("fields.h5"), "base_rings");
  EXPECT_NEAR(-rings.find("sigma_zz")->value[0], of("base.centre_pressure") * of("cone.rho_g_h"),
              0.05 * of("cone.rho_g_h"));
  EXPECT_EQ(rings.find("sigma_rz")->value[0], 0) << "no shear on the axis";
  // The models' cone ends where the grains' flank does.
  const Field model = read_field(out("fields.h5"), "model_cone_osl");
  double reach = 0;
  for (Eigen::Index k = 0; k < model.points.rows(); ++k) {
    if (model.points(k, 2) > -0.99 * of("cone.height")) continue;
    if (std::isfinite(model.find("sigma_zz")->value[k])) {
      reach = std::max(reach, model.points(k, 0));
    }
  }
  EXPECT_NEAR(reach, of("cone.foot"), 0.15 * of("cone.foot"));
  const std::string page = testing::read_text(out("report.html"));
  for (const char* part :
       {"Vertical pressure by radius", "Radial shear on the base", "Pressure on the base",
        "Inside, by radius and height", "The cone, cut in the middle"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
}

// The same cones out of their file: the same figures of the analysis.
TEST_F(ConeRun, IsAnalysedAnewFromItsFile) {
  const std::string again = *folder_ / "again";
  const Output run = program("run " + *folder_ / "c.toml" + " -o " + again +
                             " --set 'grains.files=[\"" + out("snapshots.h5") + "\"]'");
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary anew = read_summary(again + "/summary.json");
  for (const char* key : {"dip.shoulder", "cone.repose_deg", "base.centre_pressure",
                          "compare.cone_osl.rel_l2", "dem.grains"}) {
    EXPECT_EQ(number(anew, key), of(key)) << key;
  }
  EXPECT_EQ(std::get<std::string>(anew.at("cone.source")), "point") << "as the file says";
  EXPECT_EQ(anew.count("dem.steps"), 0U);
}

// What the file holds is not what the case says.
TEST_F(ConeRun, FilesOfOtherConesAreNamed) {
  const std::string base =
      "check " + *folder_ / "c.toml" + " --set 'grains.files=[\"" + out("snapshots.h5") + "\"]'";
  EXPECT_EQ(program(base).code, 0);
  const std::vector<std::pair<std::string, std::string>> other{
      {"cone.source=rain", "cone.source: found \"rain\", the cone"},
      {"cone.floor=smooth", "cone.floor: found \"smooth\", the cone"},
      {"material.density=2600", "material.density: found 2600, the cone"},
      {"material.friction=0.4", "material.friction: found 0.4, the cone"},
      {"material.gravity=1.6", "material.gravity: found 1.6, the cone"},
      {"material.young=6e5", "material.young: found 600000, the forces in the cone"},
      {"material.law=linear", "material.law: found \"linear\", the cone"}};
  for (const auto& [set, what] : other) {
    const Output found = program(base + " --set " + set);
    EXPECT_EQ(found.code, 2) << set;
    EXPECT_THAT(found.err, HasSubstr(what));
  }
}

// Warnings of what is there, and of nothing that is not.
TEST_F(ConeRun, WarnsOfWhatToMind) {
  const std::string again = *folder_ / "wide";
  const Output run =
      program("run " + *folder_ / "c.toml" + " -o " + again + " --set 'grains.files=[\"" +
              out("snapshots.h5") + "\"]' --set average.width_diameters=3");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("warning: The averaging is"));
  const Summary wide = read_summary(again + "/summary.json");
  EXPECT_THAT(std::get<std::string>(wide.at("warnings")), HasSubstr("The averaging is"));
  EXPECT_THAT(testing::read_text(again + "/report.html"), HasSubstr("The averaging is"));
  const std::string warnings =
      summary_.contains("warnings") ? std::get<std::string>(summary_.at("warnings")) : "";
  EXPECT_EQ(warnings.find("The averaging is") != std::string::npos,
            of("average.width") > 0.25 * of("cone.height"));
  // The models' cone beside the rounded heap.
  EXPECT_NEAR(of("cone.model_over_height"), of("cone.apex_height") / of("cone.height"), 0.02);
  EXPECT_EQ(warnings.find("times as high as the grains' rounded heap") != std::string::npos,
            of("cone.model_over_height") > 1.1);
  EXPECT_GT(of("cone.model_over_weight"), 0.3);
  const double lost = of("cone.grains_lost");
  EXPECT_EQ(warnings.find("of the grains left the floor") != std::string::npos,
            lost > 0.05 * (lost + of("dem.grains")));
}

// The field tells a model its slope and where its apex is: as far away as in the run.
TEST_F(ConeRun, FieldsAreComparedWithTheirOwnSlope) {
  const std::string folder = *folder_ / "compared";
  const Output run =
      program("compare " + out("fields.h5") + " --field base_rings --model cone_osl -o " + folder);
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary compared = read_summary(folder + "/summary.json");
  // The run draws both sides, so its relative L2 counts the axis half as much: place by place.
  const auto told = [](const std::string& file, const std::string& profile) {
    std::map<double, double> out;  // the model's pressure by place
    std::istringstream lines(testing::read_text(file));
    for (std::string line; std::getline(lines, line);) {
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (cells.size() > 5 && cells[0] == profile && cells[5] != "nan") {
        out[std::stod(cells[2])] = std::stod(cells[5]);
      }
    }
    return out;
  };
  const auto here = told(folder + "/profiles.csv", "base_rings");
  const auto there = told(out("profiles.csv"), "base");
  EXPECT_GE(here.size(), 8u);
  for (const auto& [x, pressure] : here) {
    const auto at = there.lower_bound(x - 1e-9);
    ASSERT_TRUE(at != there.end() && at->first < x + 1e-9) << x;
    EXPECT_NEAR(at->second, pressure, 1e-3 * of("cone.rho_g_h")) << x;
  }
  EXPECT_NEAR(number(compared, "heap.rho_g_h"), of("cone.rho_g_h"), 1e-6 * of("cone.rho_g_h"));
}

TEST_F(ConeRun, EveryFigureIsDeclared) {
  for (const auto& [key, value] : summary_) EXPECT_NE(find_summary_key(key), nullptr) << key;
}

TEST(ConeCase, BitsAreTheSameOnThreadsAndAfterAKill) {
  std::string text = kCone;
  text.replace(text.find("source = \"point\""), 16, "source = \"rain\" ");
  text.replace(text.find("mouth = 0.006\n"), 14, "");
  text.replace(text.find("floor_radius = 0.045"), 20, "floor_radius = 0.03 ");
  testing::expect_same_bits(text);
}

TEST(ConeCase, MistakesAreNamed) {
  const auto says = [](const std::vector<std::string>& set, const std::string& what) {
    EXPECT_THAT(complaint(kCone, set), HasSubstr(what));
  };
  EXPECT_EQ(complaint(kCone), "");
  says({"cone.source=rains"}, "cone.source: found \"rains\", allowed: point | rain | cylinder");
  says({"cone.mouth=0.001"}, "cone.mouth: found 0.001, allowed: at least 0.0024 m");
  says({"cone.shape=superellipsoid"}, "material.law: found \"hertz\", allowed for superellipsoids");
  says({"heap.centre=0.3"}, "heap.centre: found 0.3, allowed: up to heap.shoulder_from = 0.2");
  says({"compare.models=[\"osl\"]"}, "compare.models");
  says({"compare.models=[\"cone_osl\", \"boussinesq\"]"},
       "compare.models: found \"boussinesq\", which is no model of a heap under its weight, "
       "allowed: ");
  says({"material.young=70"}, "material.young: found 70 Pa, allowed: at least");
  says({"material.rolling_stiffness=0"}, "material.rolling_stiffness: found 0, allowed with");
  says({"motion.energy_balance=true"}, "motion.energy_balance: found true");
  says({"average.depths=[0.5]"}, "average.depths");
}

// On a plate that is too small the foot is cut, and the models' cone is another body than the dome.
TEST(ConeCase, ACutFootIsWarnedOf) {
  const Folder folder;
  const Output run = program("run " + folder.write("c.toml", kCone) + " -o " + (folder / "out") +
                             " --set cone.floor_radius=0.025 --set ensemble.realizations=1 --set "
                             "output.report=false");
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary summary = read_summary(folder / "out/summary.json");
  const std::string warnings = std::get<std::string>(summary.at("warnings"));
  EXPECT_THAT(warnings, HasSubstr("of the grains left the floor, so the cones' foot is cut off: "
                                  "raise cone.floor_radius"));
  EXPECT_THAT(warnings, HasSubstr("times as high as the grains' rounded heap"));
  EXPECT_GT(number(summary, "cone.model_over_height"), 1.1);
  EXPECT_THAT(run.err, HasSubstr("warning: The models' cone"));
}

TEST(ConeCase, CheckTellsThatFiniteElementsAreNotCounted) {
  const Folder folder;
  const std::string file = folder.write("c.toml", kCone);
  EXPECT_THAT(program("check " + file).out, Not(HasSubstr("finite elements")));
  EXPECT_THAT(program("check " + file + " --set 'compare.models=[\"fe_cone\"]'").out,
              HasSubstr("besides, finite elements (fe_cone), not counted here"));
}

// A cone of points of support with a known pressure p = rho g h (1 - s)(1 + 2 s), s = r/foot.
dem::Snapshot known_cone(double height, double foot, ConeFrame& frame) {
  dem::Snapshot s;
  s.dim = 3;
  s.gravity = dem::Vec3(0, 0, -10);
  s.walls.resize(1);
  s.walls[0].name = "floor";
  frame = {};
  frame.height = height;
  frame.foot = foot;
  frame.apex_x = 0.3;
  frame.apex_y = -0.2;
  frame.volume_fraction = 0.6;
  frame.grain_density = 2000;
  frame.gravity = 10;
  const int rings = 400, around = 64;
  for (int i = 0; i < rings; ++i) {
    const double share = (i + 0.5) / rings, r = foot * share;
    const double area = 2 * std::numbers::pi * r * foot / rings / around;
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5) / around;
      dem::Grain g;
      g.id = static_cast<std::int64_t>(s.grains.size());
      s.grains.push_back(g);
      dem::Contact c;
      c.i = g.id;
      c.j = -1;
      c.point =
          dem::Vec3(frame.apex_x + r * std::cos(angle), frame.apex_y + r * std::sin(angle), 0);
      c.force = dem::Vec3(0, 0, frame.pressure() * (1 - share) * (1 + 2 * share) * area);
      s.contacts.push_back(c);
    }
  }
  return s;
}

TEST(ConeWindows, AreMeansOverDiskAndRing) {
  ConeFrame frame;
  const dem::Snapshot cone = known_cone(0.1, 0.2, frame);
  HeapSetup setup;
  setup.centre = 0.25;
  setup.shoulder_from = 0.25;
  setup.shoulder_to = 0.5;
  const ConeWindows windows = cone_windows(cone, frame, setup);
  // Integral of (1 + s - 2 s^2) 2 s ds = s^2 + 2/3 s^3 - s^4.
  const auto below = [](double s) { return s * s + 2.0 / 3 * s * s * s - s * s * s * s; };
  EXPECT_NEAR(windows.mean.centre, below(0.25) / (0.25 * 0.25), 1e-3);
  EXPECT_NEAR(windows.mean.shoulder, (below(0.5) - below(0.25)) / (0.25 - 0.0625), 1e-3);
  EXPECT_NEAR(windows.sector_error, 0, 1e-9) << "all sectors are alike";
  EXPECT_EQ(windows.in_disk, 100 * 64);
  // Too few contacts say nothing: no false dip from an empty disk.
  setup.centre = 1e-4;
  const ConeWindows empty = cone_windows(cone, frame, setup);
  EXPECT_EQ(empty.in_disk, 0);
  EXPECT_TRUE(std::isnan(empty.mean.centre));
  EXPECT_EQ(judge_dip({empty.mean, empty.mean, empty.mean, empty.mean}).verdict, "undecided");
}

TEST(ConeSectors, ShareTheAngle) {
  for (int k = 0; k < kConeSectors; ++k) {
    const double middle = (k + 0.5) * 2 * std::numbers::pi / kConeSectors;
    for (const double off : {-0.49, 0.0, 0.49}) {
      const double angle = middle + off * 2 * std::numbers::pi / kConeSectors;
      EXPECT_EQ(cone_sector(std::cos(angle), std::sin(angle)), k);
    }
  }
  EXPECT_EQ(cone_sector(1, -1e-300), cone_sector(1, 0));
}

// Spheres filling a cone whose slope changes a little round the axis.
TEST(ConeFrame, MeasuresSlopesBySector) {
  dem::Snapshot s;
  s.dim = 3;
  s.gravity = dem::Vec3(0, 0, -9.81);
  dem::Wall floor;
  floor.name = "floor";
  floor.normal = dem::Vec3::UnitZ();
  s.walls.push_back(floor);
  const double radius = 0.5, height = 20, degree = std::numbers::pi / 180;
  // Twice round: the axis of the grains stays the cone's.
  const auto slope_at = [&](double angle) { return 28 + 3 * std::sin(2 * angle); };
  std::mt19937 draw(3);
  std::uniform_real_distribution<double> place(-50, 50), up(0, height);
  while (s.grains.size() < 60000) {
    dem::Grain g;
    g.position = dem::Vec3(place(draw), place(draw), up(draw));
    const double angle = std::atan2(g.position.y(), g.position.x());
    const double slope = std::tan(slope_at(angle) * degree);
    if (g.position.z() + radius > height - slope * g.position.head<2>().norm()) continue;
    g.id = static_cast<std::int64_t>(s.grains.size());
    g.radius = radius;
    g.volume = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
    g.mass = g.volume;
    s.grains.push_back(g);
  }
  const ConeFrame frame = cone_frame(s);
  EXPECT_NEAR(frame.repose_deg, 28, 0.7);
  EXPECT_NEAR(frame.apex_height(), height, 0.05 * height);
  for (int k = 0; k < kConeSectors; ++k) {
    const double middle = (k + 0.5) * 2 * std::numbers::pi / kConeSectors;
    // The mean of the sine over the eighth.
    const double share = std::sin(std::numbers::pi / 4) / (std::numbers::pi / 4);
    EXPECT_NEAR(frame.sector_repose_deg[static_cast<std::size_t>(k)],
                28 + 3 * share * std::sin(2 * middle), 0.8)
        << k;
  }
}

// Sectors of independent values scatter as the ring's mean does from one cone to the next; what all
// sectors share has no error.
TEST(ConeBase, SectorsTellTheErrorOfARing) {
  const RingPlaces rings = ring_places({0, 0}, Eigen::VectorXd::LinSpaced(2, 1, 3), 0.05);
  dem::Random random(5);
  double squared = 0, told = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    Eigen::VectorXd values(rings.places.rows());
    for (double& v : values) v = random.uniform(-1, 1);
    const double mean = ring_means(rings, values)[1];
    const double error = ring_sector_errors(rings, values, kConeSectors)[1];
    squared += mean * mean / kTrials;
    told += error * error / kTrials;
  }
  EXPECT_NEAR(told / squared, 1, 0.1);
  const Eigen::VectorXd same = Eigen::VectorXd::Constant(rings.places.rows(), 2);
  EXPECT_EQ(ring_sector_errors(rings, same, kConeSectors)[0], 0);
  EXPECT_TRUE(std::isnan(ring_sector_errors(rings, same, 1000)[1]));
}

}  // namespace
}  // namespace grainfield::coupling
