// Nested dissection: against a dense factorization on random matrices of a lattice's cells, the
// same bits again, and equations without a solution.
#include "continuum/fe/nested_factors.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "continuum/fe/quadratic_triangles.h"

namespace grainfield::continuum::fe {
namespace {

/// n x n squares with two unknowns on every corner, cells of random matrices.
struct Lattice {
  std::vector<std::vector<unsigned int>> cells;
  std::vector<Eigen::Vector2d> centres;
  std::vector<double> matrices;
  std::vector<NestedEntry> entries;
  Eigen::MatrixXd dense;

  explicit Lattice(unsigned int n) {
    std::mt19937 random(n);
    std::uniform_real_distribution<double> any(-1, 1);
    const unsigned int unknowns = 2 * (n + 1) * (n + 1);
    dense = Eigen::MatrixXd::Zero(unknowns, unknowns);
    for (unsigned int j = 0; j < n; ++j) {
      for (unsigned int i = 0; i < n; ++i) {
        const unsigned int corner = j * (n + 1) + i;
        std::vector<unsigned int> cell;
        for (const unsigned int node : {corner, corner + 1, corner + n + 1, corner + n + 2})
          for (const unsigned int d : {0u, 1u}) cell.push_back(2 * node + d);
        centres.emplace_back(i, j);
        for (const unsigned int a : cell)
          for (const unsigned int b : cell) {
            matrices.push_back(any(random) + (a == b ? 2 : 0));
            dense(a, b) += matrices.back();
          }
        cells.push_back(std::move(cell));
      }
    }
    for (unsigned int k = 0; k + 1 < unknowns; k += 14) {
      entries.push_back({k, k + 1, any(random)});
      dense(k, k + 1) += entries.back().value;
    }
  }
};

template <typename Scalar>
void compare_with_dense(double tolerance) {
  for (const unsigned int n : {1u, 2u, 3u, 7u, 20u}) {
    const Lattice lattice(n);
    const auto unknowns = static_cast<std::size_t>(lattice.dense.rows());
    NestedFactors<Scalar> factors(lattice.cells, lattice.centres, unknowns);
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(lattice.dense.rows(), -1, 2);
    const Eigen::VectorXd exact = lattice.dense.partialPivLu().solve(right);
    Eigen::VectorXd first;
    for (int again = 0; again < 2; ++again) {
      ASSERT_TRUE(factors.factorize(lattice.matrices, lattice.entries));
      Eigen::VectorXd found = right;
      factors.solve(found);
      EXPECT_LT((found - exact).norm(), tolerance * exact.norm()) << n;
      if (again == 0) first = found;
      EXPECT_EQ(found, first);
    }
  }
}

// Random matrices of cells amplify round-off by their condition.
TEST(NestedFactors, SolveWhatADenseFactorizationSolves) {
  compare_with_dense<double>(1e-9);
  compare_with_dense<float>(1e-2);
}

TEST(NestedFactors, AnUnknownWithoutEquationIsSaid) {
  Lattice lattice(6);
  NestedFactors<double> factors(lattice.cells, lattice.centres,
                                static_cast<std::size_t>(lattice.dense.rows()));
  // The first unknown is in the first cell alone: its row there, and the entry beside it.
  for (std::size_t j = 0; j < 8; ++j) lattice.matrices[j] = 0;
  lattice.entries.clear();
  EXPECT_FALSE(factors.factorize(lattice.matrices, lattice.entries));
  lattice.matrices[0] = 1;
  EXPECT_TRUE(factors.factorize(lattice.matrices, lattice.entries));
}

// Cells that are stiff against one motion of twelve, as nearly incompressible ones are: single
// precision alone does not come near, and what solve() gives meets the equations all the same.
TEST(NestedFactors, WhatSinglePrecisionCannotIsSolvedInDouble) {
  for (const double stiff : {1., 1e5, 1e6, 1e8}) {
    QuadraticTriangles grid(triangle_lattice({-1, 0}, {1, 0}, {0, 1}, 12));
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(-1, 1);
    grid.clear_matrix();
    const std::vector<bool> free(grid.unknowns(), true);
    for (const QuadraticCell& cell : grid.cells) {
      const CellVector motion = CellVector::NullaryExpr([&] { return any(random); });
      grid.add(cell, CellMatrix(stiff * motion * motion.transpose() + CellMatrix::Identity()),
               free);
    }
    ASSERT_TRUE(grid.factorize());
    const Eigen::VectorXd right =
        Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(grid.unknowns()), -1, 2);
    Eigen::VectorXd x = right;
    grid.solve(x);
    // Round-off of the products in double precision; at 1e6 single precision leaves 2e-7.
    EXPECT_LT((grid.product(x) - right).norm(), (1e-12 + 1e-15 * stiff) * right.norm()) << stiff;
  }
}

TEST(NestedFactors, WhatIsNoNumberStaysNone) {
  QuadraticTriangles grid(triangle_lattice({-1, 0}, {1, 0}, {0, 1}, 2));
  grid.clear_matrix();
  const std::vector<bool> free(grid.unknowns(), true);
  for (const QuadraticCell& cell : grid.cells) grid.add(cell, CellMatrix::Identity(), free);
  ASSERT_TRUE(grid.factorize());
  Eigen::VectorXd x = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(grid.unknowns()));
  x[3] = std::numeric_limits<double>::infinity();
  grid.solve(x);
  EXPECT_FALSE(x.allFinite());
}

}  // namespace
}  // namespace grainfield::continuum::fe
