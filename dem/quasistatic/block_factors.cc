#include "dem/quasistatic/block_factors.h"

#include <Eigen/LU>
#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/cuthill_mckee_ordering.hpp>
#include <limits>
#include <span>

namespace grainfield::dem {
namespace {

constexpr int kSize = BlockRows::kSize;
// A pivot whose inverse is larger than this over the pivot's size is singular; it gets this share
// of the largest entry of its diagonal block, or of the matrix where that is zero.
constexpr double kMostCondition = 1e10;
constexpr double kShift = 1e-3;

BlockRows::Block inverse_of(const BlockRows::Block& pivot, double size) {
  const BlockRows::Block out = pivot.inverse();
  if (out.allFinite() && out.norm() * pivot.norm() <= kMostCondition) return out;
  const BlockRows::Block shifted = pivot + kShift * size * BlockRows::Block::Identity();
  const BlockRows::Block again = shifted.inverse();
  if (again.allFinite() && again.norm() * shifted.norm() <= kMostCondition) return again;
  return BlockRows::Block::Identity() / size;
}

}  // namespace

void BlockRows::find_order(const Eigen::SparseMatrix<double>& matrix) {
  using Graph =
      boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS,
                            boost::property<boost::vertex_color_t, boost::default_color_type>>;
  const int n = static_cast<int>(matrix.rows()) / kSize;
  Graph graph(static_cast<std::size_t>(n));
  for (int column = 0; column < n; ++column) {
    for (int k = outer_[column * kSize]; k < outer_[column * kSize + 1]; k += kSize) {
      if (inner_[k] / kSize < column) boost::add_edge(inner_[k] / kSize, column, graph);
    }
  }
  order_.resize(static_cast<std::size_t>(n));
  boost::cuthill_mckee_ordering(graph, order_.rbegin(), get(boost::vertex_color, graph),
                                boost::make_degree_map(graph));
  std::vector<int> place(order_.size());
  for (int row = 0; row < n; ++row) place[order_[row]] = row;

  struct Entry {
    int column, from;
  };
  std::vector<std::vector<Entry>> entries(order_.size());
  for (int column = 0; column < n; ++column) {
    for (int k = outer_[column * kSize]; k < outer_[column * kSize + 1]; k += kSize)
      entries[place[inner_[k] / kSize]].push_back({place[column], k});
  }
  start_.assign(1, 0);
  column_.clear();
  from_.clear();
  diagonal_.clear();
  for (int row = 0; row < n; ++row) {
    std::ranges::sort(entries[row], {}, &Entry::column);
    for (const Entry& e : entries[row]) {
      if (e.column == row) diagonal_.push_back(static_cast<int>(column_.size()));
      column_.push_back(e.column);
      from_.push_back(e.from);
    }
    start_.push_back(static_cast<int>(column_.size()));
  }
}

void BlockRows::set(const Eigen::SparseMatrix<double>& matrix, double factor) {
  const std::span outer(matrix.outerIndexPtr(), matrix.outerSize() + 1);
  const std::span inner(matrix.innerIndexPtr(), matrix.nonZeros());
  if (!std::ranges::equal(outer, outer_) || !std::ranges::equal(inner, inner_)) {
    outer_.assign(outer.begin(), outer.end());
    inner_.assign(inner.begin(), inner.end());
    find_order(matrix);
    blocks_.resize(column_.size());
  }
  for (int row = 0; row < rows(); ++row) {
    for (int k = start_[row]; k < start_[row + 1]; ++k) {
      const int first = order_[column_[k]] * kSize;
      const int length = outer_[first + 1] - outer_[first];
      const double* const values = matrix.valuePtr() + from_[k];
      blocks_[k] = factor * Eigen::Map<const Block, 0, Eigen::OuterStride<>>(
                                values, Eigen::OuterStride<>(length));
    }
  }
}

BlockRows::Vector BlockRows::sorted(const Vector& x) const {
  Vector out(x.size());
  for (int row = 0; row < rows(); ++row)
    out.segment<kSize>(row * kSize) = x.segment<kSize>(order_[row] * kSize);
  return out;
}

BlockRows::Vector BlockRows::unsorted(const Vector& x) const {
  Vector out(x.size());
  for (int row = 0; row < rows(); ++row)
    out.segment<kSize>(order_[row] * kSize) = x.segment<kSize>(row * kSize);
  return out;
}

void BlockRows::multiply(const Vector& x, Vector& y) const {
  y.resize(x.size());
  for (int row = 0; row < rows(); ++row) {
    Eigen::Matrix<double, kSize, 1> sum = Eigen::Matrix<double, kSize, 1>::Zero();
    for (int k = start_[row]; k < start_[row + 1]; ++k)
      sum.noalias() += blocks_[k] * x.segment<kSize>(column_[k] * kSize);
    y.segment<kSize>(row * kSize) = sum;
  }
}

void BlockFactors::compute(const BlockRows& matrix) {
  std::vector<BlockRows::Block> factors = matrix.blocks_;
  const int n = matrix.rows();
  pivots_.resize(static_cast<std::size_t>(n));
  double most = std::numeric_limits<double>::min();
  for (const int k : matrix.diagonal_)
    most = std::max(most, factors[k].diagonal().cwiseAbs().maxCoeff());

  std::vector<int> place(pivots_.size(), -1);  // of each column in the present row
  for (int row = 0; row < n; ++row) {
    const int begin = matrix.start_[row], end = matrix.start_[row + 1], at = matrix.diagonal_[row];
    const double size = factors[at].diagonal().cwiseAbs().maxCoeff();
    for (int k = begin; k < end; ++k) place[matrix.column_[k]] = k;
    for (int k = begin; k < at; ++k) {
      const int above = matrix.column_[k];
      factors[k] = (factors[k] * pivots_[above]).eval();
      for (int u = matrix.diagonal_[above] + 1; u < matrix.start_[above + 1]; ++u) {
        const int hit = place[matrix.column_[u]];
        if (hit >= 0) factors[hit].noalias() -= factors[k] * factors[u];
      }
    }
    pivots_[row] = inverse_of(factors[at], size > 0 ? size : most);
    for (int k = begin; k < end; ++k) place[matrix.column_[k]] = -1;
  }

  lower_.clear();
  upper_.clear();
  lower_counts_.resize(pivots_.size());
  upper_counts_.resize(pivots_.size());
  for (int row = 0; row < n; ++row) {
    lower_counts_[row] = matrix.diagonal_[row] - matrix.start_[row];
    upper_counts_[row] = matrix.start_[row + 1] - matrix.diagonal_[row] - 1;
    for (int k = matrix.start_[row]; k < matrix.diagonal_[row]; ++k)
      lower_.push_back({factors[k], matrix.column_[k]});
  }
  for (int row = n - 1; row >= 0; --row) {
    for (int k = matrix.diagonal_[row] + 1; k < matrix.start_[row + 1]; ++k)
      upper_.push_back({factors[k], matrix.column_[k]});
  }
}

void BlockFactors::solve(const BlockRows::Vector& b, BlockRows::Vector& x) const {
  const int n = static_cast<int>(pivots_.size());
  x.resize(b.size());
  Eigen::Matrix<double, kSize, 1> sum;
  const Entry* next = lower_.data();
  for (int row = 0; row < n; ++row) {
    sum = b.segment<kSize>(row * kSize);
    for (const Entry* const end = next + lower_counts_[row]; next != end; ++next)
      sum.noalias() -= next->block * x.segment<kSize>(next->column * kSize);
    x.segment<kSize>(row * kSize) = sum;
  }
  next = upper_.data();
  for (int row = n - 1; row >= 0; --row) {
    sum = x.segment<kSize>(row * kSize);
    for (const Entry* const end = next + upper_counts_[row]; next != end; ++next)
      sum.noalias() -= next->block * x.segment<kSize>(next->column * kSize);
    x.segment<kSize>(row * kSize).noalias() = pivots_[row] * sum;
  }
}

}  // namespace grainfield::dem
