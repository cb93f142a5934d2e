// A sparse matrix of square blocks, summed from pairs of rows.
#pragma once
#include <Eigen/SparseCore>
#include <utility>
#include <vector>

namespace grainfield::dem {

/// The compressed columns of a matrix of n by n blocks of `size` rows each, all zero, that has the
/// diagonal blocks and those of `pairs` (i, j), i != j, each once, in both halves. A matrix that
/// has these places already is only set to zero.
void lay_out_blocks(int n, int size, const std::vector<std::pair<int, int>>& pairs,
                    Eigen::SparseMatrix<double>& matrix);

/// First place of block (row, column) in its first column; from column to column of the block it is
/// the whole column's length further.
int place_of_block(const Eigen::SparseMatrix<double>& matrix, int size, int row, int column);

}  // namespace grainfield::dem
