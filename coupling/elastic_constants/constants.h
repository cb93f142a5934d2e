// Isotropic elastic constants of the plane from changes of stress and strain
// (docs/elastic-constants.md).
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "coupling/elastic_constants/increments.h"
#include "coupling/statistics/bootstrap.h"

namespace grainfield::coupling {

/// A constant with the interval of its bootstrap over realizations; nan where undefined.
struct Constant {
  double value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation of the draws
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

/// Percentile intervals, which hold the truth more often than bca for the ratios of sums that
/// elastic constants are (figures in docs/elastic-constants.md).
inline BootstrapOptions elastic_bootstrap() {
  BootstrapOptions options;
  options.interval = "percentile";
  return options;
}

struct ElasticOptions {
  BootstrapOptions bootstrap = elastic_bootstrap();
};

/// Plane strain: sigma = (K - G) tr(eps) 1 + 2 G eps.
struct IsotropicConstants {
  Constant bulk;     ///< K of the plane, N/m: tr sigma = 2 K tr eps (Roul 3.16)
  Constant shear;    ///< G, N/m (Roul 3.17)
  Constant young;    ///< E = 3 G - G^2/K, N/m (Roul 3.19)
  Constant poisson;  ///< nu = (1 - G/K)/2 (Roul 3.18)
  /// Share of the stress that the fit explains (r squared about 0) of trace and deviator: 1 is
  /// linear without scatter. Fitting strain to stress instead would give K / bulk_share.
  double bulk_share = std::numeric_limits<double>::quiet_NaN();
  double shear_share = std::numeric_limits<double>::quiet_NaN();
  int realizations = 0;
  int samples = 0;   ///< pairs of stress and strain with a weight above 0 and no nan
  std::string note;  ///< why something is nan or outside what is possible; "" if nothing is
};

/// Least squares of the traces for K and of the deviators (two normal components and twice the
/// shear) for G over the samples, weighted (Roul 3.15 to 3.19; one sample gives his formulas).
/// Without change of volume K, E and nu are nan; without shear G, E and nu are. Throws
/// std::invalid_argument as check_increments() and bootstrap().
IsotropicConstants isotropic_constants(const Increments& increments, const Locality& where,
                                       const ElasticOptions& options);

}  // namespace grainfield::coupling
