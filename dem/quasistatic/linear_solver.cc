#include "dem/quasistatic/linear_solver.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "dem/quasistatic/block_factors.h"

namespace grainfield::dem {
namespace {
class BlockProduct;
}
}  // namespace grainfield::dem

// What Eigen asks of a matrix that it knows by its products alone
// (https://eigen.tuxfamily.org/dox/group__MatrixfreeSolverExample.html).
namespace Eigen::internal {
template <>
struct traits<grainfield::dem::BlockProduct> : traits<SparseMatrix<double>> {};
}  // namespace Eigen::internal

namespace grainfield::dem {
namespace {

class BlockProduct : public Eigen::EigenBase<BlockProduct> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = false
  };

  BlockProduct() = default;
  explicit BlockProduct(const BlockRows& rows) : rows_(&rows) {}
  Eigen::Index rows() const { return rows_ ? rows_->rows() * BlockRows::kSize : 0; }
  Eigen::Index cols() const { return rows(); }
  const BlockRows& rows_of_blocks() const { return *rows_; }
  template <class Rhs>
  Eigen::Product<BlockProduct, Rhs, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Rhs>& x) const {
    return {*this, x.derived()};
  }

 private:
  const BlockRows* rows_ = nullptr;
};

}  // namespace
}  // namespace grainfield::dem

namespace Eigen::internal {
template <class Rhs>
struct generic_product_impl<grainfield::dem::BlockProduct, Rhs, SparseShape, DenseShape,
                            GemvProduct>
    : generic_product_impl_base<grainfield::dem::BlockProduct, Rhs,
                                generic_product_impl<grainfield::dem::BlockProduct, Rhs>> {
  template <class Dest>
  static void scaleAndAddTo(Dest& out, const grainfield::dem::BlockProduct& matrix, const Rhs& x,
                            double factor) {
    VectorXd y;
    matrix.rows_of_blocks().multiply(x, y);
    out.noalias() += factor * y;
  }
};
}  // namespace Eigen::internal

namespace grainfield::dem {
namespace {

// A pivot off the diagonal is taken only when the diagonal one is this much smaller: the tangent is
// dominated by its symmetric, definite part, and diagonal pivots keep the factors sparse.
constexpr double kPivotThreshold = 0.01;
constexpr int kMostIterations = 500;
// What so many iterations may leave of the right side: Newton's method gets on with it.
constexpr double kMostLeft = 0.5;

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
class IncompleteFactors {
 public:
  template <class M>
  IncompleteFactors& analyzePattern(const M&) {
    return *this;
  }
  template <class M>
  IncompleteFactors& factorize(const M& matrix) {
    factors_.compute(matrix.rows_of_blocks());
    return *this;
  }
  template <class M>
  IncompleteFactors& compute(const M& matrix) {
    return factorize(matrix);
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const {
    Eigen::VectorXd x;
    factors_.solve(b, x);
    return x;
  }
  Eigen::ComputationInfo info() const { return Eigen::Success; }

 private:
  BlockFactors factors_;
};

class IterativeSolver final : public LinearSolver {
 public:
  IterativeSolver() {
    solver_.setTolerance(kLinearTolerance);
    solver_.setMaxIterations(kMostIterations);
  }
  bool prepare(const Matrix& matrix) override {
    rows_.set(matrix, -1);
    product_ = BlockProduct(rows_);
    solver_.compute(product_);
    return true;
  }
  void solve(const Vector& rhs, Vector& x) override {
    const Vector found = solver_.solve(Vector(-rows_.sorted(rhs)));
    x = rows_.unsorted(found);
    if (!(solver_.error() <= kMostLeft))
      x.setConstant(rhs.size(), std::numeric_limits<double>::quiet_NaN());
  }

 private:
  BlockRows rows_;
  BlockProduct product_;
  Eigen::BiCGSTAB<BlockProduct, IncompleteFactors> solver_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver() { return std::make_unique<DirectSolver>(); }
std::unique_ptr<LinearSolver> make_iterative_solver() {
  return std::make_unique<IterativeSolver>();
}

void solve_anywhere(LinearSolver& solver, const LinearSolver::Vector& rhs,
                    LinearSolver::Vector& x) {
  solver.solve(rhs, x);
  if (x.allFinite()) return;
  LinearSolver::Vector other(rhs.size()), added;
  for (Eigen::Index k = 0; k < other.size(); ++k) {
    const auto number = static_cast<double>(k);
    other[k] = std::cos(number * number);  // disordered
  }
  other *= rhs.norm() / other.norm();
  solver.solve(other, added);
  solver.solve(rhs + other, x);
  x -= added;
}

}  // namespace grainfield::dem
