// A packing settled by the engine: every averaging carries the weight above every cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/averaging/average.h"
#include "coupling/averaging/weights.h"
#include "coupling/tasks/average_task.h"
#include "tests/coupling/settled_scene.h"

namespace grainfield::coupling {
namespace {

// 32 grains wide: the kernels carry the weight up to the unbalanced forces; RVEs of 90 grains up to
// the levers of the contacts at their edges (docs/averaging.md, "Horizontal cuts").
TEST(Cuts, ForceIsTheWeightAbove) {
  const dem::Snapshot& s = test::settled_layer();
  const LayerFrame frame = layer_frame(s);
  const double d = mean_diameter(s);
  for (const Method& method : methods())
    for (const std::string& kernel : method.kernels()) {
      AverageOptions options;
      options.method = method.name;
      options.kernel = kernel;
      const bool smooth = method.name == "coarse_graining";
      options.width = smooth ? d : 5 * d;
      double worst = 0, mean = 0;
      for (int k = 0; k < 9; ++k) {
        const double error = cut_force(s, frame.floor + 0.1 * k * frame.depth(), options).error();
        worst = std::max(worst, std::abs(error));
        mean += error / 9;
      }
      EXPECT_LT(worst, smooth ? 5e-4 : 0.01) << method.name << " " << kernel;
      EXPECT_LT(std::abs(mean), smooth ? 5e-4 : 0.002) << method.name << " " << kernel;
      RecordProperty(method.name + "_" + kernel, std::to_string(worst));
    }
}

// Side walls and ends change the share of an RVE that is inside, not the weight that a cut carries:
// small RVEs, whose edges take shares of grains, keep to 1 % too.
TEST(Cuts, SmallElementsCarryTheWeightBetweenTheWalls) {
  const dem::Snapshot& s = test::settled_layer();
  const LayerFrame frame = layer_frame(s);
  for (const std::string& kernel : support_names()) {
    AverageOptions options;
    options.method = "area_exact";
    options.kernel = kernel;
    options.width = 2.5 * mean_diameter(s);
    for (int k = 0; k < 9; ++k)
      EXPECT_NEAR(cut_force(s, frame.floor + 0.1 * k * frame.depth(), options).error(), 0, 0.01)
          << kernel << k;
  }
}

TEST(Cuts, TableHoldsEveryAveraging) {
  AverageOptions options;
  options.width = 1;
  const auto rows = balance_table(test::settled_layer(), options);
  ASSERT_EQ(rows.size(), 7u);
  for (const BalanceRow& row : rows) {
    EXPECT_GT(row.inside.points, 100) << row.method;
    if (row.method != "coarse_graining") {
      EXPECT_GT(row.inside.rms, 10 * rows[0].inside.rms);
    }
  }
  EXPECT_LT(rows[0].base.rms, 1e-3);
  EXPECT_LT(rows[0].inside.rms, 1e-3);
  EXPECT_LT(rows[0].surface.rms, 1e-3);
  const std::string text = balance_markdown(rows);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 9);
}

}  // namespace
}  // namespace grainfield::coupling
