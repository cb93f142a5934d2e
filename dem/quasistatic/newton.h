// Newton's method by KINSOL with line search and a sparse unsymmetric factorization.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <string>
#include <vector>

namespace grainfield::dem {

struct NewtonProblem {
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::SparseMatrix<double>;
  /// r(z), scaled so that 1 is a large value; false: not defined there, try nearer.
  std::function<bool(const Vector& z, Vector& r)> residual;
  /// Its derivative at z, where the residual is r.
  std::function<void(const Vector& z, const Vector& r, Matrix& matrix)> tangent;
  /// A residual that will do when Newton's convergence has become slow there; empty: none.
  std::function<bool(const Vector& r)> enough;
};

struct NewtonSettings {
  double tolerance = 1e-10;  ///< largest |r| to be reached
  int max_iterations = 50;
  double most_step = 0.25;  ///< a longer step (largest |dz|) is shortened
};

struct NewtonReport {
  bool converged = false;
  int iterations = 0;
  double norm = 0;              ///< largest |r| at the end
  std::vector<double> history;  ///< largest |r| before each iteration, and at the end
  std::string why;              ///< not converged: KINSOL's reason
};

/// Improves z, the first guess. Without convergence z is the last iterate.
NewtonReport solve(const NewtonProblem& problem, const NewtonSettings& settings,
                   Eigen::VectorXd& z);

}  // namespace grainfield::dem
