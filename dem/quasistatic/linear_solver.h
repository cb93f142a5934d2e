// Linear equations of a tangent stiffness: by factors, or of large packings in space by iteration.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

namespace grainfield::dem {

class LinearSolver {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::SparseMatrix<double>;

  virtual ~LinearSolver() = default;
  /// Makes ready for this matrix, which must live until the last solve; false: singular, where
  /// that is looked at.
  virtual bool prepare(const Matrix& matrix) = 0;
  /// x of matrix x = rhs; not finite where no x was found.
  virtual void solve(const Vector& rhs, Vector& x) = 0;
};

/// Sparse unsymmetric factors of Eigen; the order of elimination stays while the pattern does.
std::unique_ptr<LinearSolver> make_direct_solver();
/// BiCGSTAB to kLinearTolerance of the right side, or where that takes too long to half of it,
/// preconditioned by incomplete factors (block_factors.h). For tangents of spheres, six unknowns
/// each, which friction makes unsymmetric here and there.
std::unique_ptr<LinearSolver> make_iterative_solver();

/// The solver's x, also of a right side at which BiCGSTAB breaks down: such as are 0 nearly
/// everywhere, a load on one grain. There one that is 0 nowhere is added, and its solution taken
/// away again. Not finite where no x was found.
void solve_anywhere(LinearSolver& solver, const LinearSolver::Vector& rhs, LinearSolver::Vector& x);

/// Share of the right side that a solution by iteration may leave.
inline constexpr double kLinearTolerance = 1e-4;

}  // namespace grainfield::dem
