#include "coupling/statistics/least_squares.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "continuum/constants.h"

namespace grainfield::coupling {

LeastSquares least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                           const Eigen::VectorXd& weights) {
  if (a.rows() != b.rows())
    throw std::invalid_argument(fmt::format(
        "least squares: {} rows of the matrix, {} of the right side", a.rows(), b.rows()));
  if (weights.size() != 0 && weights.size() != a.rows())
    throw std::invalid_argument(
        fmt::format("least squares: {} rows, {} weights", a.rows(), weights.size()));
  if (!a.allFinite() || !b.allFinite() || !weights.allFinite())
    throw std::invalid_argument("least squares: a number is not finite");
  if (weights.size() != 0 && weights.minCoeff() < 0)
    throw std::invalid_argument("least squares: a weight is negative");

  const Eigen::Index n = a.cols();
  Eigen::MatrixXd matrix = a, right = b;
  if (weights.size() != 0) {
    const Eigen::VectorXd root = weights.cwiseSqrt();
    matrix = root.asDiagonal() * matrix;
    right = root.asDiagonal() * right;
  }
  LeastSquares result;
  result.solution = Eigen::MatrixXd::Constant(n, b.cols(), kNan);
  result.covariance = Eigen::MatrixXd::Constant(n, n, kNan);
  result.condition = std::numeric_limits<double>::infinity();
  result.data = right.squaredNorm();
  result.residual = kNan;
  if (n == 0 || a.rows() == 0) return result;

  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  result.rank = static_cast<int>(qr.rank());
  if (result.rank < n) return result;
  const Eigen::MatrixXd triangle = qr.matrixR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::VectorXd singular = triangle.jacobiSvd().singularValues();
  result.condition = singular[0] / singular[n - 1];
  result.solution = qr.solve(right);
  result.residual = (matrix * result.solution - right).squaredNorm();
  const Eigen::MatrixXd inverse =
      qr.colsPermutation() *
      triangle.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(n, n));
  result.covariance = inverse * inverse.transpose();
  return result;
}

}  // namespace grainfield::coupling
