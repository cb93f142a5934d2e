// Whether many correlated values differ from what they should be by more than their realizations'
// spread allows, with far fewer realizations than values.
//
// Dempster (Annals of Mathematical Statistics 29, 995 (1958); Bai and Saranadasa, Statistica Sinica
// 6, 311 (1996)): no covariance is inverted. With S the sample covariance of R realizations and d
// the difference of their mean from the truth, F = R |d|^2 / tr S has about Fisher's F distribution
// with f and (R - 1) f degrees of freedom, f = (tr Sigma)^2 / tr Sigma^2 the number of independent
// values, estimated from both traces and
// kept small where few realizations leave it uncertain.
#pragma once
#include <Eigen/Core>

namespace grainfield::coupling {

struct Agreement {
  double ratio = 0;    ///< F: 1 in the mean where there is no difference; nan without a spread
  double values = 0;   ///< f
  double freedom = 0;  ///< of the spread: (R - 1) f; infinite where it is known
  /// The ratio that chance exceeds in about 1 of 100; nan without a spread.
  double chance = 0;

  bool holds() const { return ratio <= chance; }
};

/// `difference`: of the means from what they should be, one per value; `deviations`: values x
/// realizations, from their mean; both in units in which the values count alike. `extra`: variance
/// of what they should be, as a share of the mean's (1/R): R/N where it is the mean of N other
/// realizations. With one realization or no spread all is nan.
Agreement agreement(const Eigen::VectorXd& difference, const Eigen::MatrixXd& deviations,
                    double extra = 0);

/// The same with known errors of independent groups of `tied` values each.
Agreement agreement(const Eigen::VectorXd& difference, const Eigen::VectorXd& errors, int tied);

}  // namespace grainfield::coupling
