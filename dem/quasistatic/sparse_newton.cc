#include "dem/quasistatic/sparse_newton.h"

#include <cmath>
#include <limits>

namespace grainfield::dem {
namespace {

// Newton stalls, at a corner between two branches, when so many iterations have not brought the
// residual's 2-norm below this share.
constexpr std::size_t kPatience = 6;
constexpr double kProgress = 0.9;
// Slow convergence: an iteration that leaves more than this share of the residual.
constexpr double kSlow = 0.1;
// One that has hardly helped leaves more than this.
constexpr double kHardly = 0.5;

}  // namespace

NewtonReport newton(const SparseProblem& problem, const SparseSettings& settings,
                    LinearSolver& solver, Eigen::VectorXd& z) {
  SparseProblem::Matrix matrix;
  double last = 0;      // 2-norm of the last iteration's residual
  bool hardly = false;  // lowered by it

  NewtonProblem core;
  core.residual = problem.residual;
  core.factorize = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& r) {
    problem.tangent(at, r, matrix);
    return solver.prepare(matrix);
  };
  core.solve = [&](const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
    solver.solve(rhs, x);
    if (!x.allFinite()) return;
    const double longest = x.cwiseAbs().maxCoeff();
    const bool doubtful = hardly || longest > settings.most_step;
    if (doubtful && problem.stop && problem.stop(x)) {
      x.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    if (longest > settings.most_step) x *= settings.most_step / longest;
  };
  core.enough = [&](const Eigen::VectorXd& r) {
    const double now = r.norm();
    const bool moved = last > 0, slow = moved && now > kSlow * last;
    hardly = moved && now > kHardly * last;
    last = now;
    return (slow || (settings.dear && moved)) && problem.enough && problem.enough(r);
  };
  NewtonSettings how;
  how.tolerance = settings.tolerance;
  how.max_iterations = settings.max_iterations;
  // The step's length is bounded per unknown in solve(), not as a sum over the packing.
  how.most_norm = settings.most_step * std::sqrt(static_cast<double>(z.size())) + 1;
  how.patience = kPatience;
  how.progress = kProgress;
  return newton(core, how, z);
}

}  // namespace grainfield::dem
