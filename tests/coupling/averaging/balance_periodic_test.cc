// Layers that repeat sideways: a cut through one period carries the weight of one period.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/balance.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/weights.h"
#include "tests/coupling/lattice_layer_scene.h"

namespace grainfield::coupling {
namespace {

using test::lattice_layer;
constexpr double kDiameter = test::kLatticeDiameter;

void expect_the_weight(const dem::Snapshot& s, double width, double rough, double cube) {
  for (const Method& method : methods())
    for (const std::string& kernel : method.kernels()) {
      AverageOptions options;
      options.method = method.name;
      options.kernel = kernel;
      const bool smooth = method.name == "coarse_graining";
      options.width = (smooth ? 1 : width) * kDiameter;
      const LayerFrame frame = layer_frame(s);
      for (const double share : {0.0, 0.3, 0.5}) {
        const CutForce cut = cut_force(s, frame.floor + share * frame.depth(), options);
        // The discontinuous kernel and the elements see whole grains come and go.
        // A cube's faces lie along the planes of a lattice in space.
        const double error = smooth               ? (kernel == "heaviside" ? 0.01 : 1e-4)
                             : kernel == "square" ? cube
                                                  : rough;
        EXPECT_NEAR(cut.error(), 0, error) << method.name << " " << kernel << " " << share;
      }
    }
}

// "average --balance" of such a layer said +570 %: the cut went on beyond the period.
TEST(BalancePeriodic, ACutThroughOnePeriodCarriesItsWeight) {
  expect_the_weight(lattice_layer(2, 12, 16), 2.5, 0.03, 0.03);
}

TEST(BalancePeriodic, InSpace) { expect_the_weight(lattice_layer(3, 5, 8), 1.5, 0.05, 0.15); }

TEST(BalancePeriodic, OneAxisAloneMayRepeat) {
  dem::Snapshot s = lattice_layer(2, 12, 16);
  AverageOptions narrow;
  narrow.width = kDiameter;
  const double whole = cut_force(s, 0.02, narrow).force;
  // The same layer twice as wide carries twice as much.
  EXPECT_NEAR(cut_force(lattice_layer(2, 24, 16), 0.02, narrow).force / whole, 2, 1e-6);
  s.cell.periodic[1] = true;
  AverageOptions options;
  options.width = 1;
  EXPECT_THROW(balance_table(s, options), std::invalid_argument);
}

TEST(BalancePeriodic, TheTableTellsHowFarItIs) {
  AverageOptions options;
  options.width = 1;
  std::vector<double> told;
  const auto rows =
      balance_table(lattice_layer(2, 8, 10), options, [&](double share) { told.push_back(share); });
  ASSERT_GT(told.size(), rows.size());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_NEAR(told.back(), 1, 1e-9);
  for (const BalanceRow& row : rows) {
    EXPECT_LT(std::abs(row.worst_cut), row.method == "coarse_graining" ? 0.02 : 0.1)
        << row.method << row.kernel;
  }
}

}  // namespace
}  // namespace grainfield::coupling
