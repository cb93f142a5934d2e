#include "coupling/averaging/ensemble.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace grainfield::coupling {

void Ensemble::add(const Field& field) {
  if (!fields_.empty()) {
    const Field& first = fields_.front();
    if (field.points.rows() != first.points.rows())
      throw std::invalid_argument(fmt::format("realization {} has {} points, the first one {}",
                                              fields_.size(), field.points.rows(),
                                              first.points.rows()));
    if (field.columns.size() != first.columns.size())
      throw std::invalid_argument(fmt::format("realization {} has {} columns, the first one {}",
                                              fields_.size(), field.columns.size(),
                                              first.columns.size()));
    for (std::size_t c = 0; c < field.columns.size(); ++c)
      if (field.columns[c].name != first.columns[c].name)
        throw std::invalid_argument(
            fmt::format("realization {} has column \"{}\" where the first one has \"{}\"",
                        fields_.size(), field.columns[c].name, first.columns[c].name));
  }
  fields_.push_back(field);
}

Field Ensemble::mean() const {
  if (fields_.empty()) throw std::invalid_argument("an ensemble without realizations has no mean");
  const double n = static_cast<double>(fields_.size());
  Field result = fields_.front();
  result.realizations = realizations();
  for (std::size_t c = 0; c < result.columns.size(); ++c) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(result.points.rows()), squares = sum;
    for (const Field& field : fields_) sum += field.columns[c].value;
    const Eigen::VectorXd mean = sum / n;
    for (const Field& field : fields_) squares += (field.columns[c].value - mean).cwiseAbs2();
    result.columns[c].value = mean;
    if (fields_.size() > 1)
      result.columns[c].error = (squares / (n - 1) / n).cwiseSqrt();
    else
      result.columns[c].error =
          Eigen::VectorXd::Constant(result.points.rows(), std::numeric_limits<double>::quiet_NaN());
  }
  return result;
}

Field Ensemble::with_samples() const {
  Field out = mean();
  if (realizations() < 2) return out;
  for (Column& column : out.columns) {
    if (column.name.starts_with("sigma_")) column.samples = samples(column.name);
  }
  return out;
}

Eigen::MatrixXd Ensemble::samples(const std::string& column) const {
  if (fields_.empty())
    throw std::invalid_argument("an ensemble without realizations has no samples");
  Eigen::MatrixXd all(fields_.front().points.rows(), realizations());
  for (std::size_t r = 0; r < fields_.size(); ++r) {
    const Column* found = fields_[r].find(column);
    if (!found)
      throw std::invalid_argument(fmt::format("the ensemble has no column \"{}\"", column));
    all.col(static_cast<Eigen::Index>(r)) = found->value;
  }
  return all;
}

}  // namespace grainfield::coupling
