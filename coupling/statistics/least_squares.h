// Weighted linear least squares by an orthogonal decomposition.
#pragma once
#include <Eigen/Core>

namespace grainfield::coupling {

/// Solution of min over X of sum over rows k of w_k |a_k X - b_k|^2.
struct LeastSquares {
  Eigen::MatrixXd solution;    ///< unknowns x right sides; nan where the rank is not full
  double condition = 0;        ///< largest over smallest singular value of sqrt(w) A; inf: singular
  int rank = 0;                ///< of sqrt(w) A
  double residual = 0;         ///< sum over rows of w |a X - b|^2
  double data = 0;             ///< sum over rows of w |b|^2
  Eigen::MatrixXd covariance;  ///< of each right side's unknowns when its residuals have variance
                               ///< 1/w: (A^T W A)^-1; scale by residual/(rows - unknowns) for
                               ///< residuals of unknown variance. nan where the rank is not full
};

/// Column-pivoting QR of sqrt(w) A (Eigen). A: rows x unknowns, b: rows x right sides; an empty
/// `weights` means 1. Fewer rows than unknowns or dependent columns: rank below the unknowns, nan,
/// no exception. Throws std::invalid_argument when the sizes differ, or a number is not finite, or
/// a weight is negative.
LeastSquares least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                           const Eigen::VectorXd& weights = {});

}  // namespace grainfield::coupling
