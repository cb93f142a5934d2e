#include "coupling/strain/neighbourhood.h"

#include <algorithm>
#include <cmath>

#include "coupling/statistics/least_squares.h"

namespace grainfield::coupling {

Neighbourhood::Neighbourhood(const Eigen::MatrixXd& places, const std::string& support,
                             double reach)
    : places_(places),
      square_(support == "square"),
      reach_(reach),
      cells_(places.leftCols(2), 0, places.rows(), reach) {}

std::vector<Eigen::Index> Neighbourhood::around(const Eigen::VectorXd& point) const {
  std::vector<Eigen::Index> inside;
  const Eigen::Vector2d at = point.head<2>(), reach = Eigen::Vector2d::Constant(reach_);
  cells_.near(at - reach, at + reach, [&](Eigen::Index k) {
    double squares = 0, largest = 0;
    for (Eigen::Index axis = 0; axis < point.size(); ++axis) {
      const double d = std::abs(places_(k, axis) - point[axis]);
      squares += d * d;
      largest = std::max(largest, d);
    }
    if (square_ ? largest < reach_ : squares < reach_ * reach_) inside.push_back(k);
  });
  return inside;
}

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& all, const std::vector<Eigen::Index>& rows) {
  Eigen::MatrixXd chosen(static_cast<Eigen::Index>(rows.size()), all.cols());
  for (std::size_t k = 0; k < rows.size(); ++k)
    chosen.row(static_cast<Eigen::Index>(k)) = all.row(rows[k]);
  return chosen;
}

void fit_gradient(const Eigen::MatrixXd& lengths, const Eigen::MatrixXd& changes,
                  double largest_condition, GradientFit& fit) {
  const LeastSquares solved = least_squares(lengths, changes);
  fit.condition = solved.condition;
  if (!(solved.condition <= largest_condition)) {
    fit.verdict = GradientFit::Verdict::degenerate;
    return;
  }
  fit.verdict = GradientFit::Verdict::good;
  fit.gradient = solved.solution.transpose();
  fit.misfit = solved.data > 0 ? std::sqrt(solved.residual / solved.data) : 0;
}

}  // namespace grainfield::coupling
