// Pearson's correlation with its interval.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/statistics/bootstrap.h"

namespace grainfield::coupling {

struct Correlation {
  double r = 0;                ///< Pearson's coefficient, -1 to 1
  BootstrapInterval interval;  ///< of r
  int pairs = 0;               ///< used: those without nan
  int realizations = 0;        ///< drawn from
  double slope = 0;            ///< of the straight line y = intercept + slope x by least squares
  double intercept = 0;
};

/// Correlation of the pairs (x_k, y_k), each counted as independent; pairs with a nan are left out.
/// Below three pairs, or when x or y does not vary, r is nan. Throws std::invalid_argument when the
/// lengths differ, or as bootstrap().
Correlation correlation(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                        const BootstrapOptions& options);

/// The same where pair k belongs to realization[k] (any numbers): whole realizations are drawn, so
/// that points of one packing, which are not independent, do not make the interval too narrow.
Correlation correlation(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                        const std::vector<int>& realization, const BootstrapOptions& options);

}  // namespace grainfield::coupling
