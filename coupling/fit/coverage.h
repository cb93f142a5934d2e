// How often the errors that fits quote hold, tried on the realizations themselves: a few are drawn
// out of many and fitted, and the constants of the rest are taken for the truth.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "coupling/fit/fit.h"
#include "coupling/fit/selection.h"

namespace grainfield::coupling {

struct CoverageOptions {
  std::vector<int> sizes{4, 6, 8};  ///< realizations drawn
  int draws = 100;                  ///< of each size
  double huber = 0;
  int bootstrap = 200;
  bool profile = true;
  double level = 0.95;
  std::uint64_t seed = 1;
  int threads = 1;  ///< the bits do not depend on it
};

/// Coverage of one constant, over draws where neither it nor the rest's is at a bound. The rest
/// have an error, too: intervals of n out of N are wider by sqrt(1 + n / (N - n)).
struct ConstantCoverage {
  std::string model, parameter;
  int size = 0, draws = 0;
  /// Shares of the intervals that hold the constant of the rest; nan for 0 draws.
  double by_covariance = 0, by_bootstrap = 0, by_jackknife = 0, by_profile = 0;
  double spread = 0;  ///< standard deviation of the constant over the draws
  double covariance_error = 0, jackknife_error = 0;  ///< root mean squares of those quoted
};

/// Coverage of the verdict, over the draws of one size.
struct VerdictCoverage {
  int size = 0, draws = 0;
  int named = 0;  ///< draws in which the best model was distinguishable from the others
  int wrong = 0;  ///< of these, those whose model all realizations together have behind
  /// Draws whose mean "disagrees" with the mean of the rest by statistics/agreement.h: by chance.
  int false_alarms = 0;
};

struct Coverage {
  std::vector<ConstantCoverage> constants;
  std::vector<VerdictCoverage> verdicts;
  /// Models that all realizations together cannot distinguish from the nearest.
  std::vector<std::string> kept;
};

/// Throws std::invalid_argument for sizes below 3, or above half of the realizations.
/// What models take from the packings (slopes) is measured on the drawn ones and on the rest.
Coverage coverage_of(const FitData& data, const std::vector<FitModel>& models,
                     const CoverageOptions& options);

/// Markdown tables; below the constants a row of each size over all of them.
std::string coverage_text(const Coverage& coverage, int realizations);

}  // namespace grainfield::coupling
