// How many realizations would distinguish two models, foreseen from those at hand.
//
// Two models are told apart when their paired difference D, of mean m and standard deviation s over
// the realizations, is beyond chance, and when they differ enough from each other (judge.h):
//   m sqrt(n)/s' > t(n - 1),   s' the spread found in n;   2 |model - best|^2 > t s'/sqrt(n).
// The number n is the least for which both happen in 80 of 100 ensembles. What is at hand gives
// m/s with an error of its own. From few realizations the plain ratio is too large in the mean,
// because small spreads are divided by, and its sign is chosen after the fact, because whichever
// model is nearer is called the nearest. So m/s is the value of which half of the ensembles would
// find a smaller ratio (noncentral t, without sign), and the range goes by the same for 10 and 90
// in 100.
#pragma once
#include <limits>

#include "coupling/judge/judgement.h"

namespace grainfield::coupling {

struct PairedDifference {
  double mean = 0, error = 0;  ///< of D, its standard error; nan error: no number is foreseen
  /// |model - best|^2 in the unit of D; infinite where numbers are free, which asks nothing of it.
  double distance = std::numeric_limits<double>::infinity();
  int realizations = 3;
  bool error_is_known = false;  ///< of a single field with errors: it is not that of a spread
};

/// The numbers of realizations; all nan where the error is.
Power power_of(const PairedDifference& difference);

/// Realizations after which a paired difference of this mean and standard deviation is beyond
/// chance (two-sided t test, 95 %) in 80 of 100 ensembles; infinite where the mean is 0.
double realizations_for_power(double mean, double deviation);

}  // namespace grainfield::coupling
