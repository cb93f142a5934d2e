// As fe_manufactured_test.cc, on three-dimensional meshes of up to 1e5 unknowns.
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

TEST(ManufacturedSlow, ThreeDimensionsDegreeOne) { expect_orders(3, 1, 0.3, 2, 5); }
TEST(ManufacturedSlow, ThreeDimensionsDegreeTwo) { expect_orders(3, 2, 0.3, 1, 4); }
TEST(ManufacturedSlow, ThreeDimensionsHangingNodes) { expect_orders(3, 2, 0.2, 1, 3, true); }
