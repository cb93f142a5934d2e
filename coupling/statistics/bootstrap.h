// Intervals of confidence by drawing realizations with replacement (Efron and Tibshirani 1993).
//
// The realizations (packings) are what is independent; points and contacts of one packing are not.
// A statistic is therefore a function of the chosen realizations, evaluated on many draws.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace grainfield::coupling {

struct BootstrapOptions {
  /// bca: bias-corrected and accelerated (Efron 1987), second-order correct; percentile: the plain
  /// quantiles of the draws.
  std::string interval = "bca";
  /// Widens the quantiles for few realizations n (Hesterberg 2015): the spread of draws has divisor
  /// n and normal quantiles, the truth n - 1 and Student's, so the normal quantile z is replaced by
  /// sqrt(n/(n-1)) t of n - 1 degrees of freedom. Without it 10 realizations give 90 % for 95 %.
  bool widen = true;
  double level = 0.95;     ///< of confidence, above 0 and below 1
  int resamples = 2000;    ///< draws, 10 at least; 2000 give the ends of 95 % to about 5 % of their
                           ///< distance
  std::uint64_t seed = 1;  ///< same seed, same bits
  int threads = 1;         ///< the bits do not depend on it
};

/// A value with its spread over the draws, in the value's unit.
struct BootstrapInterval {
  double value = 0;   ///< the statistic of the realizations themselves
  double error = 0;   ///< standard deviation over the draws
  double low = 0;     ///< ends of the interval; nan with one realization, or where more than a
  double high = 0;    ///< tenth of the draws have no value
  int undefined = 0;  ///< draws in which the statistic was nan; they are left out
};

/// Values (one or several) of the realizations chosen; called from several threads at once. nan:
/// undefined for this choice. `chosen` has as many entries as there are realizations, each in
/// [0, realizations), with repetitions; for the jackknife of bca one fewer.
using Statistic = std::function<Eigen::VectorXd(const std::vector<int>& chosen)>;

/// resamples x values: the statistic on every draw. Draw b takes its numbers from its own stream of
/// SplitMix64, seeded by (seed, b). Throws std::invalid_argument for options out of range or fewer
/// than one realization.
Eigen::MatrixXd bootstrap_draws(int realizations, const Statistic& statistic,
                                const BootstrapOptions& options);

/// One interval per value of the statistic. Throws as bootstrap_draws().
std::vector<BootstrapInterval> bootstrap(int realizations, const Statistic& statistic,
                                         const BootstrapOptions& options);

/// The same from draws that are already there.
std::vector<BootstrapInterval> bootstrap_intervals(int realizations, const Statistic& statistic,
                                                   const Eigen::MatrixXd& draws,
                                                   const BootstrapOptions& options);

/// Quantile of sorted numbers by linear interpolation, q in [0, 1]; at least one number.
double sorted_quantile(const std::vector<double>& sorted, double q);

}  // namespace grainfield::coupling
