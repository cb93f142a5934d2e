#include "dem/quasistatic/linear_solver.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace grainfield::dem {
namespace {

// A pivot off the diagonal is taken only when the diagonal one is this much smaller: the tangent is
// dominated by its symmetric, definite part, and diagonal pivots keep the factors sparse.
constexpr double kPivotThreshold = 0.01;
constexpr int kMostIterations = 500;
// What so many iterations may leave of the right side where a fresh preconditioner does no better:
// Newton's method gets on with it.
constexpr double kMostLeft = 0.5;
// A preconditioner of an earlier matrix is made anew when it needs so many iterations more than it
// has: making one takes as long as some hundred of them.
constexpr int kMostMore = 50;

class DirectSolver final : public LinearSolver {
 public:
  DirectSolver() { factors_.setPivotThreshold(kPivotThreshold); }
  bool prepare(const Matrix& matrix) override {
    if (!is_known(matrix)) {
      factors_.analyzePattern(matrix);
      remember(matrix);
    }
    factors_.factorize(matrix);
    return factors_.info() == Eigen::Success;
  }
  void solve(const Vector& rhs, Vector& x) override { x = factors_.solve(rhs); }

 private:
  /// The pattern is that of the last matrix.
  bool is_known(const Matrix& m) const {
    return std::ranges::equal(outer_, std::span(m.outerIndexPtr(), m.outerSize() + 1)) &&
           std::ranges::equal(inner_, std::span(m.innerIndexPtr(), m.nonZeros()));
  }
  void remember(const Matrix& m) {
    outer_.assign(m.outerIndexPtr(), m.outerIndexPtr() + m.outerSize() + 1);
    inner_.assign(m.innerIndexPtr(), m.innerIndexPtr() + m.nonZeros());
  }

  Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> factors_;
  std::vector<int> outer_, inner_;
};

// What Eigen's iterative solvers ask of a preconditioner.
class SymmetricPart {
 public:
  using StorageIndex = int;
  using Matrix = Eigen::SparseMatrix<double>;

  bool stays = false;  ///< factors of an earlier matrix will do

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
    if (stays) return *this;
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
    const bool fits = solver_.rows() == matrix.rows();
    negative_ = -matrix;
    return compute(fits && least_ > 0 && last_ <= least_ + kMostMore);
  }
  void solve(const Vector& rhs, Vector& x) override {
    const bool kept = solver_.preconditioner().stays;
    if (try_to_solve(rhs, x, kept ? kLinearTolerance : kMostLeft)) return;
    if (kept && compute(false) && try_to_solve(rhs, x, kMostLeft)) return;
    x.setConstant(rhs.size(), std::numeric_limits<double>::quiet_NaN());
  }

 private:
  /// `stays`: with the preconditioner that is there.
  bool compute(bool stays) {
    solver_.preconditioner().stays = stays;
    if (!stays) least_ = last_ = 0;
    solver_.compute(negative_);
    return solver_.info() == Eigen::Success;
  }
  bool try_to_solve(const Vector& rhs, Vector& x, double most_left) {
    x = solver_.solve(Vector(-rhs));
    if (!(solver_.error() <= most_left)) return false;
    last_ = std::max<Eigen::Index>(solver_.iterations(), 1);
    least_ = least_ == 0 ? last_ : std::min(least_, last_);
    if (solver_.info() != Eigen::Success) least_ = last_ = 0;  // it does not serve
    return true;
  }

  Matrix negative_;
  Eigen::BiCGSTAB<Matrix, SymmetricPart> solver_;
  Eigen::Index least_ = 0, last_ = 0;  // iterations with this preconditioner: fewest, last
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver() { return std::make_unique<DirectSolver>(); }
std::unique_ptr<LinearSolver> make_iterative_solver() {
  return std::make_unique<IterativeSolver>();
}

}  // namespace grainfield::dem
