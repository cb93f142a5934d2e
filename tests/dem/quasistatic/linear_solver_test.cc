// Equations at which BiCGSTAB breaks down.
#include "dem/quasistatic/linear_solver.h"

#include <gmock/gmock.h>

#include <array>
#include <vector>

namespace grainfield::dem {
namespace {

using Vector = LinearSolver::Vector;

// Four grains in a ring, each of six equal unknowns. Eliminating one of them couples its
// neighbours, which the incomplete factors M leave out. For A = (1 1 0 1; 1 2 1 0; 0 1 3 1; 1 0 1
// 2) in this order, e_2 A M^-1 e_2 = 0: BiCGSTAB's first step from the right side e_2 divides by 0.
LinearSolver::Matrix ring(int first) {
  constexpr std::array<std::array<double, 4>, 4> kRing{
      {{1, 1, 0, 1}, {1, 2, 1, 0}, {0, 1, 3, 1}, {1, 0, 1, 2}}};
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double entry = -kRing[(row + first) % 4][(column + first) % 4];
      if (entry == 0) continue;
      for (int a = 0; a < 6; ++a) {  // whole blocks
        for (int b = 0; b < 6; ++b)
          entries.emplace_back(6 * row + a, 6 * column + b, a == b ? entry : 0);
      }
    }
  }
  LinearSolver::Matrix out(24, 24);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

TEST(LinearSolver, SolvesWhereTheIterationBreaksDown) {
  int broken = 0;
  for (int first = 0; first < 4; ++first) {  // whichever grain is eliminated first
    const LinearSolver::Matrix matrix = ring(first);
    const auto solver = make_iterative_solver();
    ASSERT_TRUE(solver->prepare(matrix));
    for (int k = 0; k < 24; ++k) {
      const Vector rhs = Vector::Unit(24, k);
      Vector x;
      solver->solve(rhs, x);
      const bool fails = !x.allFinite();
      broken += fails;
      solve_anywhere(*solver, rhs, x);
      ASSERT_TRUE(x.allFinite()) << first << ", " << k;
      // Tolerances of both solutions, whose right sides are at most 1 and 2 long.
      EXPECT_LT((matrix * x - rhs).norm(), 4 * kLinearTolerance) << first << ", " << k;
    }
  }
  EXPECT_GE(broken, 6);
}

}  // namespace
}  // namespace grainfield::dem
