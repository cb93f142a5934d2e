// The tail of a distribution of forces, P(f) ~ exp(-rate f) above a threshold.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace grainfield::coupling {

struct ExponentialTail {
  double threshold = 0;  ///< as given; only numbers above it are fitted
  int count = 0;         ///< numbers above the threshold
  double share = 0;      ///< of all numbers
  double rate = 0;       ///< maximum likelihood: 1 / mean excess over the threshold
  double low = 0;        ///< exact interval of the rate: 2 rate sum of excesses is chi-squared with
  double high = 0;       ///< 2 count degrees of freedom, if the numbers are independent
  double distance = 0;  ///< largest difference of the cumulative distributions (Kolmogorov-Smirnov)
  double p_value = 0;   ///< share of exponential samples of this size, fitted alike, with a larger
                        ///< distance: small means the tail is not exponential
};

struct TailOptions {
  double level = 0.95;     ///< of the rate's interval
  int simulations = 1000;  ///< exponential samples for the p-value
  std::uint64_t seed = 1;
};

/// Fits the numbers above `threshold` (both in the same unit; rate in its inverse). Because the
/// rate is fitted, the distance's tabulated distribution does not hold (Lilliefors 1969): the
/// p-value comes from simulated samples. nan are left out. Fewer than three numbers above the
/// threshold: nan with the count. Throws std::invalid_argument for options out of range or a
/// threshold that is not finite.
ExponentialTail exponential_tail(const Eigen::VectorXd& numbers, double threshold,
                                 const TailOptions& options = {});

}  // namespace grainfield::coupling
