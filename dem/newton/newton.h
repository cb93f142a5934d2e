// Newton's method with line search by KINSOL (SUNDIALS) around a linear solver of the caller's. A
// library of its own that knows neither grains nor continua: both are relaxed with it.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace grainfield {

struct NewtonProblem {
  using Vector = Eigen::VectorXd;
  /// r(u), scaled so that 1 is a large value; false: not defined there, try nearer.
  std::function<bool(const Vector& u, Vector& r)> residual;
  /// Assembles and factorizes the derivative of r at u, where it is r; false: singular.
  std::function<bool(const Vector& u, const Vector& r)> factorize;
  /// Solves with the last factors.
  std::function<void(const Vector& rhs, Vector& x)> solve;
  /// Asked once before each iteration, in order; true: stop at this r and count it as converged.
  /// Empty: never.
  std::function<bool(const Vector& r)> enough;
};

struct NewtonSettings {
  double tolerance = 1e-9;  ///< largest |r| to be reached
  int max_iterations = 25;
  double scale = 1;         ///< a large value of an unknown; steps are measured in it
  double most_norm = 1e30;  ///< longest step, 2-norm of all unknowns; as it stands: no limit
  /// Stalled: `patience` iterations have not brought the residual's 2-norm below `progress` of it.
  std::size_t patience = 12;
  double progress = 0.7;
};

struct NewtonReport {
  bool converged = false;  ///< or left because it was enough
  int iterations = 0;
  std::vector<double> history;  ///< largest |r| before each iteration, and at the end
  std::string why;              ///< not converged: the reason in words
};

/// Improves u, the first guess. Without convergence u is the last iterate. What a callback throws
/// comes through.
NewtonReport newton(const NewtonProblem& problem, const NewtonSettings& settings,
                    Eigen::VectorXd& u);

}  // namespace grainfield
