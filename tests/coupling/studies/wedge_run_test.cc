// The study of elastic-plastic heaps: shapes of base pressures, slip lines, shipped cases.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "continuum/model.h"
#include "coupling/judge/words.h"
#include "coupling/specimen/base_shape.h"
#include "coupling/specimen/slip_lines.h"
#include "coupling/store/vtu.h"
#include "tests/coupling/shipped.h"

using namespace grainfield::coupling;
using grainfield::coupling::testing::number;
using grainfield::coupling::testing::shipped;
using grainfield::coupling::testing::word;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

namespace {

std::string refusal(const std::string& name, const Overrides& overrides) {
  try {
    shipped(name, overrides);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "accepted";
}

/// Pressure of a closed wedge on a base of half width cot(28 deg).
BaseShape closed_shape(const std::string& branch) {
  const auto model = grainfield::continuum::make_model("cantelaube", {{"branch", branch}});
  const double half = 1 / std::tan(28 * std::numbers::pi / 180) * (1 - 1e-9);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(121, -half, half);
  Eigen::MatrixXd points(121, 2);
  points << x, Eigen::VectorXd::Constant(121, -1);
  return base_shape(x, -model->stress(points).col(1), half);
}

}  // namespace

TEST(WedgeRun, ShapesOfTheClosedBranches) {
  EXPECT_EQ(closed_shape("minus").word, "dip");
  EXPECT_EQ(closed_shape("zero").word, "plateau");
  EXPECT_EQ(closed_shape("plus").word, "peak");
  EXPECT_NEAR(closed_shape("zero").dip_ratio, 1, 1e-9);
  EXPECT_NEAR(closed_shape("minus").largest_at, std::tan(22.496 * std::numbers::pi / 180), 0.032);
  // One side alone that is higher is no dip: the peak lies beside the axis. A valley is one.
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(201, -1, 1);
  const Eigen::VectorXd leaning = 1 - (x.array() - 0.2).abs();
  EXPECT_EQ(base_shape(x, leaning, 1).word, "peak");
  EXPECT_NEAR(base_shape(x, leaning, 1).largest_at, 0.2, 1e-9);
  const Eigen::VectorXd valley =
      (x.array() < 0).select(1 - (x.array() + 0.3).abs(), 1.1 - (x.array() - 0.4).abs());
  EXPECT_EQ(base_shape(x, valley, 1).word, "dip");
  EXPECT_NEAR(base_shape(x, valley, 1).largest_at, 0.4, 1e-9);
  EXPECT_THROW(base_shape(Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, 1, 1), 3),
               std::invalid_argument);
}

// Under uniform stress the lines are straight, at 45 degrees - phi/2 to the larger compression.
TEST(WedgeRun, SlipLinesOfUniformStress) {
  const double phi = 30, ratio = 1. / 3;  // active: sxx = syy/3 is at the limit
  const PlaneStress stress = [&](const Eigen::MatrixXd& p) -> Eigen::MatrixXd {
    Eigen::MatrixXd out(p.rows(), 3);
    for (Eigen::Index i = 0; i < p.rows(); ++i) {
      const bool inside = p.row(i).cwiseAbs().maxCoeff() < 1;
      out.row(i) << -ratio, inside ? -1 : std::nan(""), 0;
    }
    return out;
  };
  SlipLines how;
  how.phi_deg = phi;
  Eigen::MatrixXd seeds(3, 2);
  seeds << 0, 0, 0.3, 0, 0.31, 0;  // the third is too near to the second
  const auto lines = slip_lines(stress, seeds, how);
  ASSERT_EQ(lines.size(), 4u);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Eigen::RowVector2d way = lines[k].bottomRows(1) - lines[k].topRows(1);
    // 30 degrees from the vertical.
    EXPECT_NEAR(std::abs(way[0] / way[1]), std::tan(std::numbers::pi / 6), 1e-9);
    EXPECT_GT(std::abs(way[1]), 1.9);
  }
  // Below the limit there are none.
  how.phi_deg = 40;
  EXPECT_TRUE(slip_lines(stress, seeds, how).empty());
}

TEST(WedgeRun, TrianglesAndLinesAsVtu) {
  grainfield::continuum::MeshField mesh;
  mesh.corners.resize(3, 2);
  mesh.corners << 0, 0, 1, 0, 0, 1;
  mesh.triangles = {{0, 1, 2}};
  mesh.at_corners = {{"height", Eigen::Vector3d(0, 0, 1)}};
  mesh.in_triangles = {{"share", Eigen::VectorXd::Constant(1, 0.5)}};
  const std::string text = triangles_vtu(mesh);
  EXPECT_THAT(text, HasSubstr("NumberOfPoints=\"3\" NumberOfCells=\"1\""));
  EXPECT_THAT(text, HasSubstr("Name=\"height\""));
  EXPECT_THAT(text, HasSubstr(">0 1 2 </DataArray>"));
  mesh.in_triangles[0].values.resize(2);
  EXPECT_THROW(triangles_vtu(mesh), std::invalid_argument);
  Eigen::MatrixXd line(3, 2);
  line << 0, 0, std::nan(""), 0, 1, 1;
  EXPECT_THAT(lines_vtu({line}), HasSubstr("NumberOfPoints=\"2\" NumberOfCells=\"1\""));
}

TEST(WedgeRun, HeapsBesideTheClosedWedges) {
  const StudyResult result = shipped(
      "wedge-elastoplastic.toml",
      {"compare.models=[\"associated\",\"dilation_10\",\"minus\",\"zero\",\"plus\",\"ife\"]",
       "model.associated.cells=12", "model.dilation_10.cells=12"});
  for (const std::string heap : {"associated", "dilation_10"}) {
    EXPECT_EQ(word(result, "wedge." + heap + ".base_shape"), "peak");
    EXPECT_EQ(word(result, "wedge." + heap + ".nearest"), "ife");
    EXPECT_NEAR(std::get<double>(result.summary.at("model." + heap + ".weight_ratio")), 1, 1e-6);
  }
  EXPECT_EQ(word(result, "wedge.minus.base_shape"), "dip");
  const auto file = [&](const std::string& name) {
    for (const auto& [found, text] : result.texts)
      if (found == name) return text;
    return std::string();
  };
  EXPECT_THAT(file("wedge_associated.vtu"), HasSubstr("plastic_shear"));
  EXPECT_THAT(file("slip_lines_associated.vtu"), HasSubstr("Name=\"line\""));
  EXPECT_THAT(file("core_associated.vtu"), HasSubstr("NumberOfCells=\"2\""));
  EXPECT_THAT(file("heaps.csv"), HasSubstr("associated,0."));
}

// docs/cases/wedges.md: the history moves the pressure by one per cent, soft
// ground by twice that, and none makes a dip.
TEST(WedgeRun, HistoryHardlyMovesThePressure) {
  std::vector<std::string> sets;
  const std::vector<std::string> heaps = {"at_once", "rise", "grow", "grow_frictional",
                                          "grow_soft"};
  for (const std::string& heap : heaps) {
    sets.push_back("model." + heap + ".cells=12");
    if (heap != "at_once") sets.push_back("model." + heap + ".layers=6");
  }
  const StudyResult result = shipped("wedge-construction-history.toml", sets);
  const auto figure = [&](const std::string& key) {
    return std::get<double>(result.summary.at(key));
  };
  for (const std::string& heap : heaps) {
    EXPECT_EQ(word(result, "wedge." + heap + ".base_shape"), "peak") << heap;
    EXPECT_EQ(word(result, "wedge." + heap + ".nearest"), "ife") << heap;
    EXPECT_NEAR(figure("model." + heap + ".weight_ratio"), 1, 1e-6) << heap;
    EXPECT_NEAR(figure("wedge." + heap + ".base_axis"), 0.8, 0.02) << heap;
  }
  for (const char* history : {"rise", "grow"}) {
    EXPECT_LT(figure(fmt::format("compare.{}.max", history)), 0.015) << history;
    EXPECT_GT(figure(fmt::format("compare.{}.max", history)), 1e-4) << "another way to the end";
  }
  EXPECT_LT(figure("compare.grow_soft.max"), 0.03);
}

TEST(WedgeRun, MapCountsHeapsWithoutEquilibrium) {
  const StudyResult result =
      shipped("wedge-map.toml",
              {"wedge.histories=[\"at_once\"]", "wedge.dilations_deg=[28]",
               "wedge.bases=[\"rough\",\"smooth\"]", "model.heap.cells=8", "model.heap.layers=8"});
  EXPECT_EQ(std::get<std::int64_t>(result.summary.at("wedge.heaps")), 2);
  EXPECT_EQ(std::get<std::int64_t>(result.summary.at("wedge.equilibria")), 1);
  EXPECT_THAT(word(result, "wedge.heap_at_once_dilation28_basesmooth.failed"),
              HasSubstr("no equilibrium found beyond"));
}

// Without a closed wedge beside them, and with a flank that does not yield.
TEST(WedgeRun, HeapsAlone) {
  const auto result =
      shipped("wedge-construction-history.toml",
              {"compare.models=[\"at_once\", \"grow\"]", "wedge.right_deg=15",
               "model.at_once.cells=8", "model.at_once.dilation_deg=28", "model.grow.cells=8",
               "model.grow.layers=4", "model.grow.dilation_deg=28"});
  EXPECT_THAT(
      sentence(result.comparison.judgement),
      MatchesRegex("at_once: peak .0.8[0-9]* rho g h on the axis.; grow: peak .0.8[0-9]* rho "
                   "g h on the axis.."));
  EXPECT_EQ(result.summary.count("wedge.at_once.nearest"), 0U);
  EXPECT_TRUE(std::isnan(number(result, "model.at_once.beta_hat_right_deg")));
}

TEST(WedgeRun, RefusesWhatDoesNotFit) {
  EXPECT_THAT(refusal("wedge-map.toml", {"wedge.bases=[\"wet\"]"}),
              HasSubstr("wedge.bases: found \"wet\", expected rough, smooth, or a friction angle"));
  EXPECT_THAT(refusal("wedge-map.toml", {"wedge.dilations_deg=[30]"}),
              HasSubstr("wedge.dilations_deg: found 30, expected at most wedge.phi_deg, 28"));
  EXPECT_THAT(refusal("wedge-map.toml", {"wedge.left_deg=30"}),
              HasSubstr("wedge.left_deg: found 30, expected at most wedge.phi_deg, 28: no slope"));
  EXPECT_THAT(refusal("wedge-map.toml", {"compare.models=[\"minus\",\"zero\"]"}),
              HasSubstr("compare.models: found no fe_mohr_coulomb_wedge"));
  EXPECT_THAT(refusal("wedge-map.toml", {"compare.models=[\"heap\"]"}),
              HasSubstr("compare.models: found 1 model(s)"));
}

// A setting that no combination uses is refused; one that some use is left out of the others.
TEST(WedgeRun, SettingsThatCombinationsLeaveWithoutEffect) {
  const Overrides once{"wedge.histories=[\"at_once\"]", "wedge.dilations_deg=[28]",
                       "model.heap.cells=8"};
  Overrides layers = once;
  layers.insert(layers.end(), {"wedge.bases=[\"rough\"]", "model.heap.layers=4"});
  EXPECT_THAT(refusal("wedge-map.toml", layers),
              HasSubstr("model fe_mohr_coulomb_wedge: layers = 4 has no effect with history = "
                        "at_once"));
  const Overrides springs{"wedge.histories=[\"at_once\",\"rise\"]",
                          "wedge.dilations_deg=[28]",
                          "model.heap.cells=8",
                          "wedge.bases=[\"rough\",\"25\"]",
                          "model.heap.base_stiffness=50",
                          "model.heap.layers=4"};
  EXPECT_EQ(refusal("wedge-map.toml", springs), "accepted");
}
