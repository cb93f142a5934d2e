// What is told of blocks of finite elements beside the grains, from states that are made up.
#include "coupling/studies/sample/block.h"

#include <gmock/gmock.h>

#include <cmath>

#include "continuum/constants.h"
#include "coupling/studies/sample/figures.h"

namespace grainfield::coupling {
namespace {

using Eigen::MatrixXd;
using ::testing::HasSubstr;

// Three samples, four states of a loading. The block leaves the first at 0.02, the third at 0.03,
// and could not be solved beside the second.
BlockComparison comparison() {
  BlockComparison c;
  c.strain = Eigen::VectorXd::LinSpaced(4, 0, 0.03);
  c.loading = 3;
  BlockQuantity q{"q", "Pa", MatrixXd(4, 3), {}},
      volume{"volumetric_strain", "-", MatrixXd(4, 3), {}};
  q.grains << 0, 0, 0, 10, 20, 30, 15, 25, 35, 20, 30, 40;
  volume.grains = -1e-3 * q.grains / 10;
  MatrixXd law(4, 3);
  law << 0, kNan, 0, 11, kNan, 31, 18, kNan, 37, 24, kNan, 46;
  q.laws["elastic"] = law;
  volume.laws["elastic"] = volume.grains;
  volume.laws["elastic"].col(1).setConstant(kNan);
  c.quantities = {q, volume};
  c.laws = {"elastic"};
  return c;
}

TEST(Block, FiguresAreOfTheSamplesThatCouldBeSolved) {
  const auto figures = block_figures(comparison());
  EXPECT_THAT(figures.at("block.elastic.leaves"), ::testing::ElementsAre(1, 1));
  // Off by 3 of 20, and by 6 of 40; 2 of 35 and 1 of 30 are within a tenth.
  EXPECT_THAT(figures.at("block.elastic.leaves_at"),
              ::testing::ElementsAre(::testing::DoubleNear(0.02, 1e-12),
                                     ::testing::DoubleNear(0.03, 1e-12)));
  EXPECT_THAT(figures.at("block.elastic.end_ratio"),
              ::testing::ElementsAre(::testing::DoubleNear(1.2, 1e-12),
                                     ::testing::DoubleNear(1.15, 1e-12)));
}

TEST(Block, TablesHaveErrorsOverRealizations) {
  const BlockComparison c = comparison();
  const std::string csv = block_csv(c);
  // At 0.02: differences 3 and 2, mean 2.5, standard error 0.5; grains 25 with sqrt(100/3).
  EXPECT_THAT(csv, HasSubstr("2,0.02,25,5.77350269,27.5,2.5,0.5,5,"));
  const std::vector<Section> sections = block_sections(c);
  const Table* leaving = nullptr;
  const Table* stages = nullptr;
  for (const Section& section : sections) {
    const auto* table = std::get_if<Table>(&section);
    if (table == nullptr) continue;
    if (table->title == "Where the continuum leaves the grains") leaving = table;
    if (table->title == "Stage by stage") stages = table;
  }
  ASSERT_NE(leaving, nullptr);
  ASSERT_NE(stages, nullptr);
  // Without mean stress beside the driving one, unloading and angles.
  ASSERT_EQ(leaving->rows.size(), 5U);
  EXPECT_EQ(leaving->rows.back()[1], "0.0250 ± 0.0050");
  EXPECT_EQ(stages->rows[2][2], "2.50 ± 0.50");
}

// Two states more on the way back, where the block is straight and the grains are not; and a mean
// stress beside the driving one.
TEST(Block, FiguresOfTheUnloadingAndOfTheMeanStress) {
  BlockComparison c;
  c.strain.resize(5);
  c.strain << 0, 0.01, 0.02, 0.015, 0.01;
  c.loading = 2;
  BlockQuantity axial{"sigma_zz", "Pa", MatrixXd(5, 1), {}}, mean{"p", "Pa", MatrixXd(5, 1), {}},
      volume{"volumetric_strain", "-", MatrixXd::Zero(5, 1), {}};
  axial.grains << -10, -20, -30, -10, -6;
  mean.grains << 10, 15, 20, 12, 8;
  MatrixXd driving(5, 1), pressure(5, 1);
  driving << -10, -20, -30, -25, -20;
  pressure << 10, 13, 16, 14, 13;
  axial.laws[kPlasticBlock] = driving;
  mean.laws[kPlasticBlock] = pressure;
  volume.laws[kPlasticBlock] = volume.grains;
  c.quantities = {axial, mean, volume};
  c.laws = {kPlasticBlock};
  c.friction = {36};
  c.dilation = {9};
  const auto figures = block_figures(c);
  const auto one = [&](const std::string& key) {
    return figures.at("block.mohr_coulomb." + key).at(0);
  };
  EXPECT_EQ(one("rel_l2"), 0);
  EXPECT_EQ(one("leaves"), 0);
  EXPECT_EQ(figures.count("block.mohr_coulomb.leaves_at"), 0U);
  EXPECT_NEAR(one("pressure_rel_l2"), std::sqrt((4 + 16) / (100 + 225 + 400.0)), 1e-12);
  EXPECT_NEAR(one("pressure_end_ratio"), 0.8, 1e-12);
  // Off by 2 of 20 is not more than a tenth, off by 4 is.
  EXPECT_NEAR(one("pressure_leaves_at"), 0.02, 1e-12);
  EXPECT_NEAR(one("unloading_rel_l2"), std::sqrt((225 + 196) / (100 + 36.0)), 1e-12);
  EXPECT_NEAR(one("unloading_stiffness"), 5.0 / 20, 1e-12);
  EXPECT_NEAR(one("unloaded_ratio"), 20.0 / 6, 1e-12);
  EXPECT_EQ(one("friction_deg"), 36);
  EXPECT_EQ(one("dilation_deg"), 9);
  // Unloaded to next to nothing: no ratio.
  c.quantities.front().grains(4, 0) = -0.2;
  EXPECT_EQ(block_figures(c).count("block.mohr_coulomb.unloaded_ratio"), 0U);
}

}  // namespace
}  // namespace grainfield::coupling
