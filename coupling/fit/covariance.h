// Covariance of the ensemble's mean on the points of a fit.
//
// A sample covariance of R realizations has rank R - 1, far below the number of values, and cannot
// be inverted. The kinds, from what needs most realizations to what needs least:
//   sample      the sample covariance itself; its inverse scaled by (R - n - 2)/(R - 1) (Hartlap,
//               Simon and Schneider 2007)
//   parametric  variance of a value: its own sample variance and the mean of its neighbours' in
//               equal parts; correlation: C_ab rho(d) between components a, b at the distance d,
//               C pooled over all points, rho(d) = (1 - nugget) (1 + s) exp(-s), s = sqrt(3) d/l
//               (Matern 3/2), with l fitted to the pooled correlations of all pairs of points.
//               Its inverse is scaled by inverse_bias, so that a true model has chi2/dof 1
//   diagonal    the same variances (with 2 realizations the component's mean in place of a value's
//               own), values independent of one another: their number counts too much, so
//               chi-squared and errors are scaled by n_effective / n
#pragma once
#include <Eigen/Core>
#include <limits>
#include <string>

#include "coupling/fit/data.h"

namespace grainfield::coupling {

struct Covariance {
  std::string kind;               ///< as above
  std::string note;               ///< why another kind than asked for; empty: as asked
  double correlation_length = 0;  ///< l, m; 0: not estimated
  double effective_values = 0;    ///< independent values among the n
  /// Degrees of freedom of the variances' common scale, which is estimated too: (R - 1)
  /// n_effective, sample: R - n; infinite where the errors count as known.
  double freedom = std::numeric_limits<double>::infinity();
  Eigen::MatrixXd of_mean;   ///< values x values: of the mean over the realizations, (N/m)^2
  Eigen::MatrixXd whitener;  ///< W with W^T W = inverse of of_mean (scaled as above)
};

/// Mean of sigma^2 / v for v half the sample variance of `realizations` normal values and half
/// sigma^2: by so much the inverse of `parametric` is too large (3 realizations: 1.19, 8: 1.06).
/// Throws std::invalid_argument below 2.
double inverse_bias(int realizations);

/// Realizations that a kind needs: sample n + 3, parametric 3, diagonal 2.
int least_realizations(const std::string& kind, int values);

/// `kind`: "auto" (parametric where there are realizations for it) or one of the above. Falls back
/// to the next kind with a note when there are too few realizations. With one realization: diagonal
/// with data.error where there are such, else (and where all realizations are equal) equal errors
/// of unknown size (kind "unknown", of_mean = 1), noted. Throws std::invalid_argument for an
/// unknown kind or data that do not pass check().
Covariance covariance_of(const FitData& data, const std::string& kind = "auto");

}  // namespace grainfield::coupling
