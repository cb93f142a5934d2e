// What a fit knows of its constants beside the sandwich: realizations drawn and left out, the
// profile of the misfit, and other minima within the noise.
#pragma once
#include <vector>

#include "coupling/fit/fit.h"

namespace grainfield::coupling {

/// Student's t of an interval of `level` with errors from so many realizations; normal with one,
/// whose errors count as known.
double student(int realizations, double level);

/// Standard error of a number whose values without each of the realizations these are (Efron and
/// Tibshirani 1993, 11.5).
double jackknife_error(const Eigen::VectorXd& left_out);

/// Ends of the search that are another set of constants within the noise: their misfit is above the
/// least by less than the noise of the difference (two standard errors over the realizations), and
/// some constant differs by more than its error. `free`, `spread`: of the constants about `best`.
std::vector<Eigen::VectorXd> distinct_ends(const FitData& data, const Weights& weights,
                                           const FitModel& model,
                                           const std::vector<Eigen::VectorXd>& ends,
                                           const Eigen::VectorXd& best,
                                           const std::vector<Eigen::Index>& free,
                                           const Eigen::MatrixXd& spread);

/// Fits without each of the realizations, all of it anew: what the model takes from the packings,
/// and the search from the best and from `others`. Fills left_out and turning_signs; returns the
/// jackknife's errors, nan below 3 realizations.
Eigen::VectorXd leave_out(const FitData& data, const Weights& weights, const FitModel& model,
                          const Eigen::VectorXd& best, const std::vector<Eigen::VectorXd>& others,
                          const FitOptions& options, Fit& out);

/// Interval of a constant whose limit is `floor`: (value - floor) times or divided by exp(t e), e
/// the jackknife's error of log(value - floor) by the fits without each realization.
Interval interval_above(double floor, double value, const Eigen::VectorXd& left_out, double t);

/// Standard deviations over draws of the realizations, times sqrt(R / (R - 1)); nan without.
Eigen::VectorXd bootstrap_errors(const FitData& data, const Weights& weights, const FitModel& model,
                                 const Eigen::VectorXd& best, const FitOptions& options);

/// Where the least misfit with parameter p held is `rise` above the least, to 2 % of `reach` (the
/// half width expected); a bound of the parameter where it is not reached before, infinite where it
/// is not within 63 half widths either.
Interval profile_interval(const FitData& data, const Weights& weights, const FitModel& model,
                          const Eigen::VectorXd& best, Eigen::Index p, double rise, double reach);

/// Adds one of distinct_ends() with a clause in the note.
void add_other_minimum(const FitData& data, const Weights& weights, const FitModel& model,
                       const Eigen::VectorXd& other, Fit& out);

}  // namespace grainfield::coupling
