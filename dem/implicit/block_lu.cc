#include "dem/implicit/block_lu.h"

#include <Eigen/LU>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace grainfield::dem {
namespace {

// Least fill: the block of each row.
std::vector<int> ordered(int n, const std::vector<std::pair<int, int>>& pairs) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < n; ++k) entries.emplace_back(k, k, 1);
  for (const auto& [i, j] : pairs) {
    entries.emplace_back(i, j, 1);
    entries.emplace_back(j, i, 1);
  }
  Eigen::SparseMatrix<double> graph(n, n);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::AMDOrdering<int>::PermutationType order;
  Eigen::AMDOrdering<int>()(graph, order);
  return {order.indices().data(), order.indices().data() + n};
}

// Columns right of the diagonal in each row of the factors: its own, and those of the rows that it
// is the first column of.
std::vector<std::vector<int>> filled(const std::vector<int>& rank,
                                     const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::vector<int>> upper(rank.size());
  for (const auto& [i, j] : pairs) {
    upper[std::min(rank[i], rank[j])].push_back(std::max(rank[i], rank[j]));
  }
  for (std::vector<int>& row : upper) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    if (row.empty()) continue;
    std::vector<int>& next = upper[row[0]];
    next.insert(next.end(), row.begin() + 1, row.end());
  }
  return upper;
}

}  // namespace

void BlockLu::lay_out(int n, const std::vector<std::pair<int, int>>& pairs) {
  order_ = ordered(n, pairs);
  rank_.resize(n);
  for (int k = 0; k < n; ++k) rank_[order_[k]] = k;
  const std::vector<std::vector<int>> upper = filled(rank_, pairs);
  std::vector<std::vector<int>> lower(n);
  for (int k = 0; k < n; ++k) {
    for (const int row : upper[k]) lower[row].push_back(k);
  }
  rows_ = {0};
  middle_.clear();
  columns_.clear();
  for (int k = 0; k < n; ++k) {
    columns_.insert(columns_.end(), lower[k].begin(), lower[k].end());
    middle_.push_back(static_cast<int>(columns_.size()));
    columns_.push_back(k);
    columns_.insert(columns_.end(), upper[k].begin(), upper[k].end());
    rows_.push_back(static_cast<int>(columns_.size()));
  }
  values_.resize(columns_.size());
}

int BlockLu::place(int i, int j) const {
  const auto first = columns_.begin() + rows_[rank_[i]],
             last = columns_.begin() + rows_[rank_[i] + 1];
  return static_cast<int>(std::lower_bound(first, last, rank_[j]) - columns_.begin());
}

void BlockLu::clear() { std::fill(values_.begin(), values_.end(), PaddedBlock()); }

bool BlockLu::factorize() {
  bool regular = true;
  with_lanes([&](auto width) { regular = factorize_by<width()>(); });
  return regular;
}

template <int W>
bool BlockLu::factorize_by() {
  std::vector<int> places(size());  // of the row's columns
  for (int i = 0; i < size(); ++i) {
    for (int p = rows_[i]; p < rows_[i + 1]; ++p) places[columns_[p]] = p;
    for (int p = rows_[i]; p < middle_[i]; ++p) {
      Block l = at(p);
      if ((l.array() == 0).all()) continue;
      const int k = columns_[p], first = middle_[k] + 1;
      l = (l * at(middle_[k])).eval();
      take_row_of<W>(values_[p], &values_[first], &columns_[first], rows_[k + 1] - first,
                     places.data(), values_.data());
    }
    Block pivot = at(middle_[i]);
    pivot = pivot.inverse().eval();
    if (!pivot.allFinite()) return false;
  }
  return true;
}

void BlockLu::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) const {
  std::vector<Eigen::Vector3d> y(size());
  for (int i = 0; i < size(); ++i) {
    y[i] = rhs.segment<3>(3 * order_[i]);
    for (int p = rows_[i]; p < middle_[i]; ++p) y[i] -= at(p).lazyProduct(y[columns_[p]]);
  }
  x.resize(rhs.size());
  for (int i = size() - 1; i >= 0; --i) {
    for (int p = middle_[i] + 1; p < rows_[i + 1]; ++p) {
      y[i] -= at(p).lazyProduct(y[columns_[p]]);
    }
    y[i] = (at(middle_[i]) * y[i]).eval();
    x.segment<3>(3 * order_[i]) = y[i];
  }
}

}  // namespace grainfield::dem
