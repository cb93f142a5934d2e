#include "coupling/elastic_constants/increments.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "coupling/averaging/kernel.h"

namespace grainfield::coupling {
namespace {

const Eigen::VectorXd& column(const Field& field, const char* name, const char* what) {
  const Column* found = field.find(name);
  if (!found)
    throw std::invalid_argument(fmt::format("the field of {} has no column \"{}\"", what, name));
  return found->value;
}

}  // namespace

void Increments::add(const Field& stress_change, const Field& strain_change) {
  if (stress_change.points.rows() != strain_change.points.rows() ||
      stress_change.points != strain_change.points)
    throw std::invalid_argument(fmt::format("stress and strain are on different points ({} and {})",
                                            stress_change.points.rows(),
                                            strain_change.points.rows()));
  if (stress_change.points.cols() != 2)
    throw std::invalid_argument(
        fmt::format("elastic constants need points of the plane; these have {} coordinates",
                    stress_change.points.cols()));
  if (!stress.empty() &&
      (points.rows() != stress_change.points.rows() || points != stress_change.points))
    throw std::invalid_argument(
        fmt::format("realization {} is on other points than the first one", realizations()));
  Eigen::MatrixX3d s(stress_change.points.rows(), 3), e = s;
  s.col(0) = column(stress_change, "sigma_xx", "stress");
  s.col(1) = column(stress_change, "sigma_yy", "stress");
  s.col(2) = column(stress_change, "sigma_xy", "stress");
  if (const Column* other = stress_change.find("sigma_yx"))
    s.col(2) = (s.col(2) + other->value) / 2;
  e.col(0) = column(strain_change, "strain_xx", "strain");
  e.col(1) = column(strain_change, "strain_yy", "strain");
  e.col(2) = column(strain_change, "strain_xy", "strain");
  points = stress_change.points;
  stress.push_back(s);
  strain.push_back(e);
}

Locality locality(const Eigen::MatrixXd& points, const Eigen::Vector2d& centre,
                  const std::string& kernel, double width) {
  Locality where{centre, Eigen::VectorXd::Zero(points.rows())};
  if (width == 0) {
    if (points.rows() == 0) return where;
    Eigen::Index nearest = 0;
    (points.rowwise() - centre.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    where.weights[nearest] = 1;
    return where;
  }
  const auto weight = make_kernel(kernel, width);
  for (Eigen::Index p = 0; p < points.rows(); ++p)
    where.weights[p] =
        weight->value((points.row(p).transpose() - centre).norm()) / weight->value(0);
  return where;
}

Locality everywhere(const Eigen::MatrixXd& points) {
  Locality where;
  where.weights = Eigen::VectorXd::Ones(points.rows());
  if (points.rows() > 0) where.centre = points.colwise().mean().transpose();
  return where;
}

void check_increments(const Increments& increments, const Locality& where) {
  const Eigen::Index n = increments.points.rows();
  if (increments.stress.empty())
    throw std::invalid_argument("elastic constants need at least one realization");
  if (increments.stress.size() != increments.strain.size())
    throw std::invalid_argument(fmt::format("{} realizations of stress, {} of strain",
                                            increments.stress.size(), increments.strain.size()));
  for (std::size_t r = 0; r < increments.stress.size(); ++r)
    if (increments.stress[r].rows() != n || increments.strain[r].rows() != n)
      throw std::invalid_argument(
          fmt::format("realization {} has {} stresses and {} strains at {} points", r,
                      increments.stress[r].rows(), increments.strain[r].rows(), n));
  if (where.weights.size() != n)
    throw std::invalid_argument(fmt::format("{} weights for {} points", where.weights.size(), n));
  if (n > 0 && !(where.weights.minCoeff() >= 0))
    throw std::invalid_argument("a weight of the elastic fit is negative or nan");
}

}  // namespace grainfield::coupling
