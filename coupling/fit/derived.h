// What follows from fitted constants, with errors.
#pragma once
#include <vector>

#include "coupling/fit/fit.h"

namespace grainfield::coupling {

/// K (-) and tau_deg (deg), ratio and angle of the fixed axes (Roul 4.23), of the fits that
/// have a parameter mu, and eta (-) where it follows from mu by the limit of friction at the slope
/// (Roul 4.24). Errors by linear propagation with the fit's correlations, nan where those of the
/// parameters are; low and high are nan. Empty for other fits.
std::vector<FittedParameter> derived_figures(const Fit& fit, double slope_deg);

}  // namespace grainfield::coupling
