#include "coupling/structure/mean_stress.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <cmath>

#include "coupling/averaging/region.h"
#include "coupling/statistics/spread.h"
#include "coupling/statistics/value_text.h"

namespace grainfield::coupling {

double packing_volume(const dem::Snapshot& s) {
  bool repeats = s.cell.is_periodic();
  for (int axis = 0; axis < s.dim; ++axis) {
    repeats = repeats && s.cell.periodic[static_cast<std::size_t>(axis)];
  }
  if (repeats) {
    return std::fabs(s.dim == 2 ? s.cell.edges.topLeftCorner<2, 2>().determinant()
                                : s.cell.edges.determinant());
  }
  const Region region(s);
  if (s.dim == 3) {
    return (region.right() - region.left()) * (region.back() - region.front()) *
           (region.roof().heights().mean() - region.floor());
  }
  double area = 0;
  const auto& corners = region.corners();
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    area += (corners[k + 1].x() - corners[k].x()) *
            ((corners[k].y() + corners[k + 1].y()) / 2 - region.floor());
  }
  return area;
}

Eigen::Matrix3d mean_stress(const dem::Snapshot& s) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const dem::Contact& c : s.contacts) {
    const dem::Grain& i = s.grains[static_cast<std::size_t>(c.i)];
    if (!i.fixed) sum += c.force * (c.point - i.position).transpose();
    if (c.j < 0 || s.grains[static_cast<std::size_t>(c.j)].fixed) continue;
    sum -= c.force * (c.point - dem::second_place(s, c)).transpose();
  }
  return (sum + sum.transpose()) / (2 * packing_volume(s));
}

std::string mean_stress_text(const std::vector<Eigen::Matrix3d>& packings, int dim) {
  std::vector<std::string> parts;
  for (int row = 0; row < dim; ++row) {
    for (int column = row; column < dim; ++column) {
      std::vector<double> values;
      for (const Eigen::Matrix3d& one : packings) values.push_back(one(row, column) + 0.0);
      const Spread spread = spread_of(values);
      parts.push_back(fmt::format("sigma_{}{} {}", "xyz"[row], "xyz"[column],
                                  with_error(spread.mean, spread.standard_error)));
    }
  }
  return fmt::format("{} {} (tension positive, {} packing{})", fmt::join(parts, ", "),
                     dim == 2 ? "N/m" : "Pa", packings.size(), packings.size() == 1 ? "" : "s");
}

}  // namespace grainfield::coupling
