// Bearing capacities of weightless ground with friction, associated flow: from above, falling with
// the mesh, extrapolated to Prandtl's.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "continuum/fe/plastic_verification.h"

using namespace grainfield::continuum;

namespace {

void converges(double phi, bool surcharge, const std::vector<int>& meshes, double settlement) {
  const double exact = surcharge ? prandtl_n_q(phi) : prandtl_n_c(phi);
  std::vector<double> error;
  for (const int cells : meshes) {
    Footing footing;
    footing.phi_deg = footing.dilation_deg = phi;
    footing.surcharge = surcharge;
    footing.cells = cells;
    footing.settlement = settlement;
    const FootingCheck found = check_strip_footing(footing);
    std::size_t iterations = 0;
    for (const auto& step : found.steps) iterations += static_cast<std::size_t>(step.iterations);
    std::printf(
        "phi %4.1f  N_%c  %2d squares  %6d unknowns  %8.4f  exact %8.4f  %+6.2f %%  %zu "
        "steps, %zu iterations, last rise %.1e\n",
        phi, surcharge ? 'q' : 'c', cells, found.unknowns, found.capacity, exact,
        100 * (found.capacity / exact - 1), found.steps.size(), iterations, found.last_rise);
    EXPECT_LT(found.last_rise, 2e-3) << phi << " " << surcharge << " " << cells;
    error.push_back(found.capacity / exact - 1);
    EXPECT_GT(error.back(), 0) << phi << " " << surcharge << " " << cells;
    if (error.size() > 1) {
      // The strip's border is a singular point: order 1.
      const double order = std::log2(error[error.size() - 2] / error.back());
      std::printf("phi %4.1f  N_%c  order %.3f\n", phi, surcharge ? 'q' : 'c', order);
      EXPECT_NEAR(order, 1, 0.2) << phi << " " << surcharge << " " << cells;
    }
  }
  // Order 1 from the two finest meshes, each of twice the cells of the one before.
  const double extrapolated = 2 * error.back() - error[error.size() - 2];
  std::printf("phi %4.1f  N_%c  extrapolated %+.2f %%\n", phi, surcharge ? 'q' : 'c',
              100 * extrapolated);
  EXPECT_LT(std::abs(extrapolated), 0.01) << phi << " " << surcharge;
}

}  // namespace

TEST(FeFooting, WithCohesion) {
  for (const double phi : {0., 10., 20., 30.}) converges(phi, false, {1, 2, 4}, 0.4);
}

TEST(FeFooting, WithSurcharge) {
  for (const double phi : {10., 30.}) converges(phi, true, {1, 2, 4}, 0.4);
}
