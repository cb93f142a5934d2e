// Which grains or contacts lie around a point, and the fit that the measures share.
#pragma once
#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "coupling/averaging/point_cells.h"
#include "coupling/strain/measure.h"

namespace grainfield::coupling {

/// Places (rows, 2 or 3 axes) sorted so that those in a support around any point are found quickly.
class Neighbourhood {
 public:
  /// `reach`: radius of the circle (ball) or half the side of the square (cube), m. `places` must
  /// outlive this.
  Neighbourhood(const Eigen::MatrixXd& places, const std::string& support, double reach);
  /// Rows whose place is inside the support around `point`, always in the same order.
  std::vector<Eigen::Index> around(const Eigen::VectorXd& point) const;

 private:
  const Eigen::MatrixXd& places_;
  bool square_;
  double reach_;
  std::variant<PointCells<2>, PointCells<3>> cells_;
};

/// The chosen rows of a matrix.
Eigen::MatrixXd rows_of(const Eigen::MatrixXd& all, const std::vector<Eigen::Index>& rows);

/// Fills gradient, condition, misfit and verdict of `fit` with the G that minimises
/// sum |change_k - G length_k|^2; rows k of `lengths` and `changes`, m.
void fit_gradient(const Eigen::MatrixXd& lengths, const Eigen::MatrixXd& changes,
                  double largest_condition, GradientFit& fit);

}  // namespace grainfield::coupling
