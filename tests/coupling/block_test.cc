// What is told of blocks of finite elements beside the grains, from states that are made up.
#include "coupling/studies/sample/block.h"

#include <gmock/gmock.h>

#include <cmath>

#include "continuum/constants.h"
#include "coupling/studies/sample/state_figures.h"

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
  EXPECT_THAT(csv, HasSubstr("2,0.02,25,5.7735,27.5,2.5,0.5,5,"));
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
  ASSERT_EQ(leaving->rows.size(), block_summary_keys().size());
  EXPECT_EQ(leaving->rows.back()[1], "0.025 ± 0.005");
  EXPECT_EQ(stages->rows[2][2], "2.5 ± 0.5");
}

}  // namespace
}  // namespace grainfield::coupling
