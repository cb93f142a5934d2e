#include "coupling/strain/neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "coupling/statistics/least_squares.h"

namespace grainfield::coupling {

Neighbourhood::Neighbourhood(const Eigen::MatrixXd& places, const std::string& support,
                             double reach)
    : places_(places),
      square_(support == "square"),
      reach_(reach),
      cells_(PointCells<2>({}, 0, 0, reach)) {
  if (places.cols() == 3)
    cells_ = PointCells<3>(places, 0, places.rows(), reach);
  else
    cells_ = PointCells<2>(places, 0, places.rows(), reach);
}

std::vector<Eigen::Index> Neighbourhood::around(const Eigen::VectorXd& point) const {
  std::vector<Eigen::Index> inside;
  const auto look_at = [&](Eigen::Index k) {
    double squares = 0, largest = 0;
    for (Eigen::Index axis = 0; axis < point.size(); ++axis) {
      const double d = std::abs(places_(k, axis) - point[axis]);
      squares += d * d;
      largest = std::max(largest, d);
    }
    if (square_ ? largest < reach_ : squares < reach_ * reach_) inside.push_back(k);
  };
  std::visit(
      [&](const auto& cells) {
        using Vector = typename std::decay_t<decltype(cells)>::Vector;
        const Vector at = point, reach = Vector::Constant(reach_);
        cells.near(at - reach, at + reach, look_at);
      },
      cells_);
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
