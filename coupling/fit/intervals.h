// What a fit knows of its constants beside the covariance: realizations left out, the profile of
// chi squared, and other minima within the noise.
#pragma once
#include "coupling/fit/fit.h"

namespace grainfield::coupling {

/// Student's t of an interval of `level` with errors from so many realizations; normal with one,
/// whose errors count as known.
double student(int realizations, double level);

/// Fits without each of the realizations, all of it anew: the covariance, and the search from every
/// start, which may end in another minimum. Fills left_out and turning_signs; returns the
/// jackknife's errors (Efron and Tibshirani 1993, 11.5), nan below 3 realizations.
Eigen::VectorXd leave_out(const FitData& data, const Covariance& covariance, const FitModel& model,
                          const Eigen::VectorXd& best, const FitOptions& options, Fit& out);

/// Where the least chi squared with parameter p held is `rise` above the least, to 1 % of `error`
/// (the covariance's); a bound of the parameter where it is not reached before, infinite where it
/// is not within 63 half widths either.
Interval profile_interval(const FitData& data, const Covariance& covariance, const FitModel& model,
                          const Eigen::VectorXd& best, Eigen::Index p, double rise, double error);

/// Adds ends of the search within the noise (chi squared up to t^2 above the least) that are
/// another set of constants, with a clause in the note.
void add_other_minima(const FitData& data, const Covariance& covariance, const FitModel& model,
                      const std::vector<Eigen::VectorXd>& ends, const Eigen::VectorXd& best,
                      double t, Fit& out);

}  // namespace grainfield::coupling
