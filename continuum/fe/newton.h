// Newton's method with line search by KINSOL (SUNDIALS) around a linear solver of the caller's.
// Internal to fe/.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace grainfield::continuum::fe {

struct NewtonProblem {
  using Vector = Eigen::VectorXd;
  /// r(u), scaled so that 1 is a large value.
  std::function<void(const Vector& u, Vector& r)> residual;
  /// Assembles and factorizes the derivative of r at u; false: singular.
  std::function<bool(const Vector& u)> factorize;
  /// Solves with the last factors.
  std::function<void(const Vector& rhs, Vector& x)> solve;
};

struct NewtonSettings {
  double tolerance = 1e-9;  ///< largest |r| to be reached
  int max_iterations = 25;
  double scale = 1;  ///< a large value of an unknown; steps are measured in it
};

struct NewtonReport {
  bool converged = false;
  int iterations = 0;
  std::vector<double> history;  ///< largest |r| before each iteration, and at the end
  std::string why;              ///< not converged: the reason in words
};

/// Improves u, the first guess. Without convergence u is the last iterate. What a callback throws
/// comes through.
NewtonReport newton(const NewtonProblem& problem, const NewtonSettings& settings,
                    Eigen::VectorXd& u);

}  // namespace grainfield::continuum::fe
