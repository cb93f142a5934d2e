// Horizontal rows among the points of a field: of a grid, of cuts, of a line.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace grainfield::coupling {

struct FieldRow {
  double y = 0;
  std::vector<Eigen::Index> at;  ///< indices of its points, from the left
};

/// From the lowest row up. Points whose heights differ by less than `same` share a row.
std::vector<FieldRow> horizontal_rows(const Eigen::MatrixXd& points, double same);
/// The row whose y is nearest. `rows` not empty.
const FieldRow& nearest_row(const std::vector<FieldRow>& rows, double y);

}  // namespace grainfield::coupling
