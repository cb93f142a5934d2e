// A figure over realizations: mean, standard error, and whether it is above zero.
#pragma once
#include <vector>

namespace grainfield::coupling {

/// With fewer realizations than this nothing is said about significance.
inline constexpr int least_for_significance = 3;

struct Spread {
  double mean = 0;            ///< nan without values
  double standard_error = 0;  ///< s/sqrt(n); nan below 2 values
  /// One-sided probability, by Student's t with n - 1 degrees of freedom, of a mean this high or
  /// higher if the true one were 0: near 0 says above zero, near 1 below. nan below
  /// least_for_significance values and where all are equal.
  double p_value = 0;
  int values = 0;
};

/// A value that is nan makes everything nan.
Spread spread_of(const std::vector<double>& values);

}  // namespace grainfield::coupling
