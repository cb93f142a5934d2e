// A square matrix of 3 by 3 blocks whose pattern is symmetric, and its factors in the same place.
//
// The blocks are ordered by approximate minimum degree (Eigen's AMD) once for a pattern; then each
// row is eliminated by those before it. Pivots are whole diagonal blocks: the tangent of a step is
// dominated by masses and repulsion, which are symmetric and definite, and Newton's method mends
// what round-off leaves, or does not converge and the step is halved. A row is not eliminated by
// one whose block it has 0, as of disks apart.
#pragma once
#include <Eigen/Core>
#include <utility>
#include <vector>

#include "dem/implicit/block_lanes.h"

namespace grainfield::dem {

class BlockLu {
 public:
  using Block = Eigen::Map<Eigen::Matrix3d, Eigen::Aligned32, Eigen::OuterStride<4>>;

  /// Places for n diagonal blocks and those of `pairs` (i, j), i != j, in both halves.
  void lay_out(int n, const std::vector<std::pair<int, int>>& pairs);
  int size() const { return static_cast<int>(order_.size()); }
  /// Index of block (i, j), which was laid out.
  int place(int i, int j) const;
  Block at(int place) { return Block(values_[place].numbers); }

  void clear();
  /// The matrix becomes its factors; false: singular.
  bool factorize();
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) const;

 private:
  using ConstBlock = Eigen::Map<const Eigen::Matrix3d, Eigen::Aligned32, Eigen::OuterStride<4>>;
  template <int W>
  bool factorize_by();
  ConstBlock at(int place) const { return ConstBlock(values_[place].numbers); }

  std::vector<int> order_, rank_;    // block of each row, row of each block
  std::vector<int> rows_, middle_;   // where each row begins, and its diagonal
  std::vector<int> columns_;         // ascending in each row
  std::vector<PaddedBlock> values_;  // factorized: L, inverse diagonal, U
};

}  // namespace grainfield::dem
