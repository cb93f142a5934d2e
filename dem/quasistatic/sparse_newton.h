// Newton's method with a sparse tangent.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>

#include "dem/newton/newton.h"
#include "dem/quasistatic/linear_solver.h"

namespace grainfield::dem {

struct SparseProblem {
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::SparseMatrix<double>;
  /// r(z), scaled so that 1 is a large value; false: not defined there, try nearer.
  std::function<bool(const Vector& z, Vector& r)> residual;
  /// Its derivative at z, where the residual is r.
  std::function<void(const Vector& z, const Vector& r, Matrix& matrix)> tangent;
  /// A residual that will do, when Newton's convergence has become slow there or each step is dear;
  /// empty: none.
  std::function<bool(const Vector& r)> enough;
  /// Asked for a step that has to be shortened, and for one after an iteration that has hardly
  /// lowered the residual; true: give up. Empty: never asked.
  std::function<bool(const Vector& step)> stop;
};

struct SparseSettings {
  double tolerance = 1e-10;  ///< largest |r| to be reached
  int max_iterations = 50;
  double most_step = 0.25;  ///< a longer step (largest |dz|) is shortened
  bool dear = false;        ///< a step is: after the first one what is enough is not bettered
};

/// Improves z, the first guess. Without convergence z is the last iterate. `solver` serves one
/// Newton after the other, and keeps what it can.
NewtonReport newton(const SparseProblem& problem, const SparseSettings& settings,
                    LinearSolver& solver, Eigen::VectorXd& z);

}  // namespace grainfield::dem
