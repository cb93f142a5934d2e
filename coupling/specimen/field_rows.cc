#include "coupling/specimen/field_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainfield::coupling {

std::vector<FieldRow> horizontal_rows(const Eigen::MatrixXd& points, double same) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(points.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index a, Eigen::Index b) { return points(a, 1) < points(b, 1); });
  std::vector<FieldRow> out;
  for (const Eigen::Index k : order) {
    if (out.empty() || points(k, 1) - out.back().y >= same) out.push_back({points(k, 1), {}});
    out.back().at.push_back(k);
  }
  for (FieldRow& row : out) {
    std::sort(row.at.begin(), row.at.end(),
              [&](Eigen::Index a, Eigen::Index b) { return points(a, 0) < points(b, 0); });
  }
  return out;
}

const FieldRow& nearest_row(const std::vector<FieldRow>& rows, double y) {
  return *std::min_element(rows.begin(), rows.end(), [y](const FieldRow& a, const FieldRow& b) {
    return std::fabs(a.y - y) < std::fabs(b.y - y);
  });
}

}  // namespace grainfield::coupling
