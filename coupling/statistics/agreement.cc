#include "coupling/statistics/agreement.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>

namespace grainfield::coupling {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Towards few values: at 3 realizations, where it is least certain, too large a number refuses true
// models. Tried on values of 2 to 60 independent ones.
constexpr double kCaution = 0.4;
// Fisher's F has lighter tails than sums of unequal variances: with 0.005 the share that chance
// refuses is 0.1 to 2 of 100 (tests/coupling/judge/agreement_test.cc).
constexpr double kNominal = 0.005;

// (tr Sigma)^2 / tr Sigma^2 from the realizations' products, both traces without bias (Bai and
// Saranadasa 1996, 3.4). From two realizations nothing is known of it: 1.
double independent_values(const Eigen::MatrixXd& products, Eigen::Index values) {
  const auto r = static_cast<double>(products.rows());
  if (r < 3) return 1;
  const double n = r - 1, trace = products.trace() / n, squares = products.squaredNorm() / (n * n);
  const double of_squares = n * n / ((n + 2) * (n - 1)) * (squares - trace * trace / n);
  const double of_trace = trace * trace - 2 * of_squares / n;
  if (!(of_trace > 0)) return 1;
  const double share = std::max(0.0, of_squares / of_trace) + kCaution / (n * n);
  return std::clamp(1 / share, 1.0, static_cast<double>(values));
}

}  // namespace

Agreement agreement(const Eigen::VectorXd& difference, const Eigen::MatrixXd& deviations,
                    double extra) {
  const auto r = static_cast<double>(deviations.cols());
  const Eigen::MatrixXd products = deviations.transpose() * deviations;
  const double trace = r > 1 ? products.trace() / (r - 1) : 0;
  if (!(trace > 0)) return {kNan, kNan, kNan, kNan};
  Agreement out;
  out.values = independent_values(products, difference.size());
  out.freedom = (r - 1) * out.values;
  out.ratio = r * difference.squaredNorm() / trace / (1 + extra);
  out.chance =
      boost::math::quantile(complement(boost::math::fisher_f(out.values, out.freedom), kNominal));
  return out;
}

Agreement agreement(const Eigen::VectorXd& difference, const Eigen::VectorXd& errors, int tied) {
  const Eigen::VectorXd variances = errors.cwiseAbs2();
  const double trace = variances.sum();
  if (!(trace > 0)) return {kNan, kNan, kNan, kNan};
  Agreement out;
  out.values = std::max(1.0, trace * trace / variances.squaredNorm() / tied);
  out.freedom = std::numeric_limits<double>::infinity();
  out.ratio = difference.squaredNorm() / trace;
  out.chance = boost::math::quantile(complement(boost::math::chi_squared(out.values), kNominal)) /
               out.values;
  return out;
}

}  // namespace grainfield::coupling
