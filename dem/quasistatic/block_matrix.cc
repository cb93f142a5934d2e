#include "dem/quasistatic/block_matrix.h"

#include <algorithm>

namespace grainfield::dem {
namespace {

// Rows of the blocks of each column of blocks, ascending.
std::vector<std::vector<int>> rows_of(int n, const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::vector<int>> rows(n);
  for (int k = 0; k < n; ++k) rows[k].push_back(k);
  for (const auto& [i, j] : pairs) {
    rows[i].push_back(j);
    rows[j].push_back(i);
  }
  for (auto& of_column : rows) std::sort(of_column.begin(), of_column.end());
  return rows;
}

}  // namespace

void lay_out_blocks(int n, int size, const std::vector<std::pair<int, int>>& pairs,
                    Eigen::SparseMatrix<double>& matrix) {
  const auto rows = rows_of(n, pairs);
  const int unknowns = n * size;
  std::vector<int> outer(unknowns + 1, 0), inner;
  inner.reserve((n + 2 * pairs.size()) * size * size);
  for (int column = 0; column < unknowns; ++column) {
    for (const int row : rows[column / size]) {
      for (int k = 0; k < size; ++k) inner.push_back(row * size + k);
    }
    outer[column + 1] = static_cast<int>(inner.size());
  }
  const bool same = matrix.rows() == unknowns && matrix.isCompressed() &&
                    matrix.nonZeros() == static_cast<Eigen::Index>(inner.size()) &&
                    std::equal(outer.begin(), outer.end(), matrix.outerIndexPtr()) &&
                    std::equal(inner.begin(), inner.end(), matrix.innerIndexPtr());
  if (!same) {
    matrix.resize(unknowns, unknowns);
    matrix.resizeNonZeros(static_cast<Eigen::Index>(inner.size()));
    std::copy(outer.begin(), outer.end(), matrix.outerIndexPtr());
    std::copy(inner.begin(), inner.end(), matrix.innerIndexPtr());
  }
  std::fill_n(matrix.valuePtr(), inner.size(), 0.0);
}

int place_of_block(const Eigen::SparseMatrix<double>& matrix, int size, int row, int column) {
  const int* const first = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column * size];
  const int* const last = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column * size + 1];
  return static_cast<int>(std::lower_bound(first, last, row * size) - matrix.innerIndexPtr());
}

}  // namespace grainfield::dem
