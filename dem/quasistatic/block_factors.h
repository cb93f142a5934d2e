// A sparse matrix of blocks of six rows, a sphere's unknowns, and its incomplete factors.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace grainfield::dem {

/// The matrix row by row of blocks, grains in the order of Cuthill and McKee reversed: neighbours
/// stand close to each other, which makes incomplete factors better and memory faster.
class BlockRows {
 public:
  static constexpr int kSize = 6;
  using Vector = Eigen::VectorXd;
  using Block = Eigen::Matrix<double, kSize, kSize>;

  /// `factor` times a matrix that consists of whole blocks (block_matrix.h), its diagonal ones
  /// among them. The order stays while the pattern does.
  void set(const Eigen::SparseMatrix<double>& matrix, double factor);

  int rows() const { return static_cast<int>(order_.size()); }  ///< of blocks
  /// x of the matrix' order in this one's, and back.
  Vector sorted(const Vector& x) const;
  Vector unsorted(const Vector& x) const;
  /// y = matrix x, both in this order.
  void multiply(const Vector& x, Vector& y) const;

 private:
  friend class BlockFactors;
  void find_order(const Eigen::SparseMatrix<double>& matrix);

  std::vector<int> outer_, inner_;  // of the matrix that has this order
  std::vector<int> order_;          // old number of each row
  std::vector<int> start_, column_, diagonal_;
  std::vector<int> from_;  // first place of each block in the matrix
  std::vector<Block> blocks_;
};

/// Incomplete factors L U with the pattern of the matrix.
class BlockFactors {
 public:
  /// `matrix` must live, with this pattern, until the last solve. A pivot that is singular is
  /// shifted.
  void compute(const BlockRows& matrix);
  /// x of L U x = b, both in the order of the matrix.
  void solve(const BlockRows::Vector& b, BlockRows::Vector& x) const;

 private:
  struct Entry {
    BlockRows::Block block;
    int column;
  };
  // The blocks of L, row by row, and of U, from the last row to the first: in the order in which
  // solve() meets them.
  std::vector<Entry> lower_, upper_;
  std::vector<int> lower_counts_, upper_counts_;  // of each row
  std::vector<BlockRows::Block> pivots_;          // inverse
};

}  // namespace grainfield::dem
