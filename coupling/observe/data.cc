#include "coupling/observe/data.h"

#include <fmt/format.h>

#include <set>
#include <stdexcept>
#include <utility>

namespace grainfield::coupling {

int FitData::tied() const {
  return static_cast<int>(std::set<int>(component.begin(), component.end()).size());
}

FitData realizations_of(const FitData& data, const std::vector<int>& chosen) {
  FitData out = data;
  out.samples = data.samples(Eigen::all, chosen);
  return out;
}

std::vector<int> rows_at(const FitData& data, int component, int level) {
  std::vector<int> out;
  for (int k = 0; k < data.values(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (data.component[at] == component && data.level[at] == level) out.push_back(k);
  }
  return out;
}

FitData rows_of(const FitData& data, const std::vector<int>& rows) {
  FitData out;
  out.components = data.components;
  out.levels = data.levels;
  const auto n = static_cast<Eigen::Index>(rows.size());
  out.points.resize(n, data.points.cols());
  out.samples.resize(n, data.samples.cols());
  if (data.error.size() > 0) out.error.resize(n);
  if (data.scale.size() > 0) out.scale.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const int row = rows[static_cast<std::size_t>(k)];
    out.points.row(k) = data.points.row(row);
    out.samples.row(k) = data.samples.row(row);
    if (data.error.size() > 0) out.error[k] = data.error[row];
    if (data.scale.size() > 0) out.scale[k] = data.scale[row];
    out.component.push_back(data.component[static_cast<std::size_t>(row)]);
    out.level.push_back(data.level[static_cast<std::size_t>(row)]);
  }
  return out;
}

void check(const FitData& data) {
  const auto n = static_cast<std::size_t>(data.samples.rows());
  if (data.points.rows() != data.samples.rows() || data.component.size() != n ||
      data.level.size() != n || data.points.cols() != 2 ||
      (data.error.size() != 0 && data.error.size() != data.samples.rows()) ||
      (data.scale.size() != 0 && data.scale.size() != data.samples.rows())) {
    throw std::invalid_argument(
        "data to fit: points, components, levels, samples, errors and units differ in size");
  }
  if (n == 0 || data.samples.cols() == 0) throw std::invalid_argument("data to fit: no values");
  for (const std::string& c : data.components) {
    if (c != "sigma_xx" && c != "sigma_yy" && c != "sigma_xy") {
      throw std::invalid_argument(
          fmt::format("data to fit: found component {}, allowed: sigma_xx, sigma_yy, sigma_xy", c));
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    if (data.component[k] < 0 || data.component[k] >= static_cast<int>(data.components.size()) ||
        data.level[k] < 0 || data.level[k] >= static_cast<int>(data.levels.size())) {
      throw std::invalid_argument("data to fit: a value of no component or no level");
    }
  }
  if (!data.samples.allFinite() || !data.points.allFinite()) {
    throw std::invalid_argument("data to fit: a value or a point is not finite");
  }
  if (data.error.size() > 0 && !(data.error.allFinite() && data.error.minCoeff() > 0)) {
    throw std::invalid_argument("data to fit: a standard error is not above 0");
  }
  if (data.scale.size() > 0 && !(data.scale.allFinite() && data.scale.minCoeff() > 0)) {
    throw std::invalid_argument("data to fit: a working unit is not above 0");
  }
}

Eigen::MatrixXd places_of(const FitData& data) {
  std::vector<int> once;
  std::set<std::pair<double, double>> seen;
  for (int k = 0; k < data.values(); ++k) {
    if (seen.emplace(data.points(k, 0), data.points(k, 1)).second) once.push_back(k);
  }
  return data.points(once, Eigen::all);
}

Places::Places(const Eigen::MatrixXd& points) : points_(points) {
  for (Eigen::Index k = 0; k < points.rows(); ++k) row_[{points(k, 0), points(k, 1)}] = k;
}

Eigen::MatrixXd Places::pick(const Eigen::MatrixXd& values, const Eigen::MatrixXd& points) const {
  if (points.rows() == points_.rows() && points == points_) return values;
  Eigen::MatrixXd out(points.rows(), values.cols());
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const auto at = row_.find({points(k, 0), points(k, 1)});
    if (at == row_.end()) throw std::logic_error("Places: a point that it does not know");
    out.row(k) = values.row(at->second);
  }
  return out;
}

}  // namespace grainfield::coupling
