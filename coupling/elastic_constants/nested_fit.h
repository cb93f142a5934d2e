// Linear stress-strain laws, one inside the other: their least squares, and whether the data ask
// for the larger one. Used by the fits of symmetries in the plane and in space.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <vector>

#include "continuum/constants.h"

namespace grainfield::coupling {

/// Equations closer to singular than this do not tell the constants apart.
inline constexpr double kLargestCondition = 1e6;
/// Sums of squares below this share of the data are rounding.
inline constexpr double kRoundingOfSquares = 1e-26;
/// Constraints below this share of the first constant are rounding.
inline constexpr double kRoundingOfConstraint = 1e-10;
/// Determinant of a covariance below this share of its mean size's power is rounding.
inline constexpr double kSingularCovariance = 1e-12;

/// A sample as equations: matrix * constants = right, in units that make their sum of squares the
/// squared norm of the stress.
template <int Rows, int Constants>
struct LinearSample {
  double weight = 1;
  Eigen::Matrix<double, Rows, Constants> matrix;
  Eigen::Matrix<double, Rows, 1> right;
};

/// All samples one below the other, for least_squares().
struct LinearSystem {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right, weights;
};

template <int Rows, int Constants>
LinearSystem system_of(const std::vector<LinearSample<Rows, Constants>>& samples) {
  const auto n = static_cast<Eigen::Index>(samples.size());
  LinearSystem s{Eigen::MatrixXd(Rows * n, Constants), Eigen::VectorXd(Rows * n),
                 Eigen::VectorXd(Rows * n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& sample = samples[static_cast<std::size_t>(k)];
    s.matrix.middleRows<Rows>(Rows * k) = sample.matrix;
    s.right.segment<Rows>(Rows * k) = sample.right;
    s.weights.segment<Rows>(Rows * k).setConstant(sample.weight);
  }
  return s;
}

/// Normal equations of one realization, for the draws; they add up.
template <int Constants>
struct NormalSums {
  Eigen::Matrix<double, Constants, Constants> matrix =
      Eigen::Matrix<double, Constants, Constants>::Zero();
  Eigen::Matrix<double, Constants, 1> right = Eigen::Matrix<double, Constants, 1>::Zero();

  template <int Rows>
  void add(const LinearSample<Rows, Constants>& sample) {
    const auto& a = sample.matrix;
    matrix += sample.weight * a.transpose() * a;
    right += sample.weight * a.transpose() * sample.right;
  }
  void add(const NormalSums& other) {
    matrix += other.matrix;
    right += other.right;
  }
  /// nan where the constants cannot be told apart.
  Eigen::Matrix<double, Constants, 1> solve() const {
    // GCC 12 takes Eigen's estimate of the condition of nine constants and more for uninitialized.
    constexpr int kSize = Constants < 9 ? Constants : Eigen::Dynamic;
    const Eigen::LDLT<Eigen::Matrix<double, kSize, kSize>> factors(matrix);
    Eigen::Matrix<double, Constants, 1> c = Eigen::Matrix<double, Constants, 1>::Constant(kNan);
    if (factors.info() == Eigen::Success && factors.rcond() > std::pow(kLargestCondition, -2))
      c = factors.solve(right);
    return c;
  }
};

/// Chance of constraints this far from zero if they hold, given their bootstrap draws over n
/// realizations: Hotelling's T squared. nan below C + 2 realizations, and where copies of one
/// packing or constraints that move together allow no test. `scale`: a large constant.
template <int C>
double hotelling(const Eigen::Matrix<double, C, 1>& constraints, const Eigen::MatrixXd& draws,
                 int n, double scale) {
  if (n < C + 2) return kNan;
  if (constraints.cwiseAbs().maxCoeff() < kRoundingOfConstraint * scale) return 1;
  Eigen::MatrixXd centred(draws.rows(), C);
  Eigen::Index rows = 0;
  for (Eigen::Index b = 0; b < draws.rows(); ++b)
    if (draws.row(b).allFinite()) centred.row(rows++) = draws.row(b);
  if (rows < draws.rows() / 2) return kNan;
  centred.conservativeResize(rows, C);
  centred.rowwise() -= Eigen::Matrix<double, 1, C>(centred.colwise().mean());
  // The spread over draws has divisor n, that of a sample n - 1.
  const Eigen::Matrix<double, C, C> covariance =
      centred.transpose() * centred / static_cast<double>(rows - 1) * n / (n - 1.0);
  const double size = covariance.trace() / C;
  if (!(size > std::pow(kRoundingOfConstraint * scale, 2))) return kNan;
  double power = kSingularCovariance;
  for (int k = 0; k < C; ++k) power = power * size;
  if (!(covariance.determinant() > power)) return kNan;
  const double t2 = constraints.dot(covariance.inverse() * constraints);
  return boost::math::cdf(
      boost::math::complement(boost::math::fisher_f(C, n - C), t2 * (n - C) / (C * (n - 1.0))));
}

/// Corrected information criterion (Hurvich and Tsai 1989) of a sum of squares; smaller is better.
inline double aicc(double squares, double equations, int constants) {
  const double k = constants + 1;  // and the variance
  return equations * std::log(squares / equations) + 2 * k + 2 * k * (k + 1) / (equations - k - 1);
}

/// F = ((R - R')/m)/(R'/(N - n)) of the sums of squares R of the smaller and R' of the larger law
/// of n constants, m fewer in the smaller, N equations; and the chance of a larger one if the
/// smaller holds and all samples are independent.
struct NestedTest {
  double f = kNan, p = kNan;
};
inline NestedTest nested_test(double smaller, double larger, double equations, int fewer,
                              int constants) {
  NestedTest out;
  out.f = std::max(0.0, (smaller - larger) / fewer / (larger / (equations - constants)));
  out.p = boost::math::cdf(
      boost::math::complement(boost::math::fisher_f(fewer, equations - constants), out.f));
  return out;
}

}  // namespace grainfield::coupling
