// Figures of one profile: peak, width, number of peaks, integral.
#pragma once
#include <Eigen/Core>

namespace grainfield::coupling {

struct ProfileShape {
  double peak = 0;     ///< largest value, in the profile's unit
  double peak_at = 0;  ///< where, m
  double fwhm = 0;  ///< distance between the outermost crossings of half the peak, m; nan if open
  double rms_width = 0;  ///< sqrt of the second central moment, m; nan unless the integral is > 0
  int peaks = 0;
  double integral = 0;  ///< trapezoidal over x
};

/// Shape of values (positive where it matters: -sigma_yy) at ascending x. `error`: standard errors
/// or empty. A local maximum counts as a peak when its prominence (height above the higher of the
/// two saddles that separate it from higher ground) exceeds the larger of 2 standard errors there
/// and 5 % of the largest value. Points that are nan are left out. Throws std::invalid_argument for
/// sizes that differ, x not ascending, or fewer than 3 values.
ProfileShape profile_shape(const Eigen::VectorXd& x, const Eigen::VectorXd& value,
                           const Eigen::VectorXd& error);

/// Standard errors of the shape of the mean profile, from the means with one realization left out
/// each (jackknife; Efron & Stein 1981); of the integral that is the standard error of the
/// realizations' integrals. `samples`: x.size() x realizations. `peaks` is 0 and `peak_at`, whose
/// place jumps from point to point, nan; so is a figure that one of the means lacks, and all with
/// fewer than two realizations or three points that all realizations have. Throws
/// std::invalid_argument for sizes that differ.
ProfileShape shape_errors(const Eigen::VectorXd& x, const Eigen::MatrixXd& samples);

}  // namespace grainfield::coupling
