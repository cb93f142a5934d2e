#include "dem/quasistatic/linear_solver.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <limits>

namespace grainfield::dem {
namespace {

// A pivot off the diagonal is taken only when the diagonal one is this much smaller: the tangent is
// dominated by its symmetric, definite part, and diagonal pivots keep the factors sparse.
constexpr double kPivotThreshold = 0.01;
constexpr int kMostIterations = 500;

class DirectSolver final : public LinearSolver {
 public:
  DirectSolver() { factors_.setPivotThreshold(kPivotThreshold); }
  bool prepare(const Matrix& matrix) override {
    factors_.compute(matrix);
    return factors_.info() == Eigen::Success;
  }
  void solve(const Vector& rhs, Vector& x) override { x = factors_.solve(rhs); }

 private:
  Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> factors_;
};

// What Eigen's iterative solvers ask of a preconditioner.
class SymmetricPart {
 public:
  using StorageIndex = int;
  using Matrix = Eigen::SparseMatrix<double>;

  SymmetricPart() = default;
  template <class M>
  explicit SymmetricPart(const M& matrix) {
    compute(matrix);
  }
  template <class M>
  SymmetricPart& analyzePattern(const M&) {
    return *this;
  }
  template <class M>
  SymmetricPart& factorize(const M& matrix) {
    const Matrix transposed = matrix.transpose();
    const Matrix part = 0.5 * (matrix + transposed);
    factors_.compute(part);
    return *this;
  }
  template <class M>
  SymmetricPart& compute(const M& matrix) {
    return factorize(matrix);
  }
  template <class Rhs>
  Eigen::VectorXd solve(const Rhs& b) const {
    return factors_.solve(b);
  }
  Eigen::ComputationInfo info() const { return factors_.info(); }

 private:
  Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>> factors_;
};

class IterativeSolver final : public LinearSolver {
 public:
  IterativeSolver() {
    solver_.setTolerance(kLinearTolerance);
    solver_.setMaxIterations(kMostIterations);
  }
  bool prepare(const Matrix& matrix) override {
    negative_ = -matrix;
    solver_.compute(negative_);
    return solver_.info() == Eigen::Success;
  }
  void solve(const Vector& rhs, Vector& x) override {
    x = solver_.solve(Vector(-rhs));
    if (solver_.info() != Eigen::Success) {
      x.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }

 private:
  Matrix negative_;
  Eigen::BiCGSTAB<Matrix, SymmetricPart> solver_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver() { return std::make_unique<DirectSolver>(); }
std::unique_ptr<LinearSolver> make_iterative_solver() {
  return std::make_unique<IterativeSolver>();
}

}  // namespace grainfield::dem
