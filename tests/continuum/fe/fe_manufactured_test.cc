// Convergence of the elements on a manufactured solution: displacement in L2 of order p + 1, stress
// (the energy norm) of order p, the recovered stress no worse than p.
#include <gtest/gtest.h>

#include <cmath>

#include "continuum/fe/verification.h"

using namespace grainfield::continuum;

namespace {

/// Of the observed order: leading-order convergence is reached, but not exactly.
constexpr double kOrder = 0.2;

void expect_orders(int dim, int degree, double nu, int first, int last, bool mixed = false) {
  ManufacturedErrors coarse = solve_manufactured(dim, degree, nu, first, mixed);
  for (int refinement = first + 1; refinement <= last; ++refinement) {
    const ManufacturedErrors fine = solve_manufactured(dim, degree, nu, refinement, mixed);
    const auto order = [](double a, double b) { return std::log2(a / b); };
    SCOPED_TRACE("dim " + std::to_string(dim) + " degree " + std::to_string(degree) +
                 " refinement " + std::to_string(refinement) + " nu " + std::to_string(nu));
    EXPECT_NEAR(order(coarse.displacement, fine.displacement), degree + 1, kOrder);
    EXPECT_NEAR(order(coarse.stress, fine.stress), degree, kOrder);
    EXPECT_GT(order(coarse.recovered, fine.recovered), degree - kOrder);
    EXPECT_LT(fine.figures.at("residual"), 1.01e-10);
    coarse = fine;
  }
}

}  // namespace

TEST(Manufactured, TwoDimensionsDegreeOne) { expect_orders(2, 1, 0.3, 3, 6); }
TEST(Manufactured, TwoDimensionsDegreeTwo) { expect_orders(2, 2, 0.3, 2, 5); }
TEST(Manufactured, TwoDimensionsDegreeThreeNearlyIncompressible) {
  expect_orders(2, 3, 0.45, 2, 4);
}
TEST(Manufactured, HangingNodesKeepTheOrder) { expect_orders(2, 2, 0.2, 2, 5, true); }
TEST(Manufactured, ThreeDimensionsDegreeOne) { expect_orders(3, 1, 0.3, 1, 3); }

TEST(Manufactured, OrthotropicConstantAndMapped) {
  const PlaneModuli soft_in_shear{2, 1, 0.3, 0.15}, two_peaks{1, 1, 0.9, 2.5};
  for (const auto& [moduli, degree, first, last] :
       {std::tuple{soft_in_shear, 1, 3, 6}, {soft_in_shear, 2, 2, 5}, {two_peaks, 3, 2, 4}}) {
    for (const bool uniform : {true, false}) {
      ManufacturedErrors coarse = solve_manufactured_map(degree, moduli, first, uniform);
      for (int refinement = first + 1; refinement <= last; ++refinement) {
        const auto fine = solve_manufactured_map(degree, moduli, refinement, uniform);
        const auto order = [](double a, double b) { return std::log2(a / b); };
        EXPECT_NEAR(order(coarse.displacement, fine.displacement), degree + 1, kOrder)
            << degree << " " << refinement << uniform;
        EXPECT_NEAR(order(coarse.stress, fine.stress), degree, kOrder) << degree << uniform;
        EXPECT_GT(order(coarse.recovered, fine.recovered), degree - kOrder) << degree << uniform;
        coarse = fine;
      }
    }
  }
}

TEST(Manufactured, IterationsHardlyGrowWithTheMesh) {
  const double few = solve_manufactured(2, 1, 0.3, 5).figures.at("cg_iterations");
  const double many = solve_manufactured(2, 1, 0.3, 7).figures.at("cg_iterations");
  EXPECT_LT(many, 1.8 * few + 5);  // without multigrid: four times as many
}
