// Least squares with fixed weights of one model on one ensemble; errors from the realizations.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "coupling/fit/model.h"
#include "coupling/fit/weights.h"
#include "coupling/observe/data.h"

namespace grainfield::coupling {

struct FitOptions {
  /// Huber's weights: a value further off than this many of its standard errors pulls no more than
  /// that; 0: plain least squares.
  double huber = 0;
  int bootstrap = 200;     ///< draws of realizations; 0: none
  bool jackknife = true;   ///< every realization left out once, where there are three or more
  bool profile = true;     ///< intervals by the profile of the misfit
  double level = 0.95;     ///< of the intervals
  std::uint64_t seed = 1;  ///< of the draws
  int threads = 1;         ///< the bits do not depend on it
};

struct Interval {
  double low = std::numeric_limits<double>::quiet_NaN(), high = low;

  bool holds(double value) const { return low <= value && value <= high; }
};

struct FittedParameter {
  FitParameter parameter;
  double value = 0;
  /// The one that is quoted: jackknife_error, below three realizations covariance_error; nan: not
  /// determined, or at a bound.
  double error = 0;
  double covariance_error = 0;  ///< of the values' spread, by the slopes of the model (sandwich)
  double bootstrap_error = 0;   ///< standard deviation over draws of the realizations; nan without
  double jackknife_error = 0;   ///< over realizations left out; nan below 3
  double low = 0, high = 0;     ///< interval of `level` that is quoted: that of `error`
  /// The same from each error, value +- Student's t times it, t of realizations - 1 degrees of
  /// freedom; and by the profile: where the least misfit with this parameter held has risen by t^2
  /// times what one covariance_error makes of it.
  Interval by_covariance, by_bootstrap, by_jackknife, by_profile;
  bool at_bound = false;   ///< the search ended at the parameter's bound: no error
  bool determined = true;  ///< false: the values do not depend on it, or on it with others alone
};

struct Fit {
  std::string name, label, equations, kind;  ///< of the model
  std::vector<FittedParameter> parameters;
  Eigen::MatrixXd correlation;  ///< of the parameters, from the covariance
  Eigen::VectorXd model;        ///< values at the best parameters, N/m
  Eigen::VectorXd residual;     ///< (mean - model) / standard error, value by value
  double misfit = 0;            ///< sum of squares of (mean - model) in working units
  double dof = 0;               ///< independent values less parameters: statistics/agreement.h
  /// Misfit over what the spread of the realizations makes of a true model's; nan where nothing is
  /// known of it. 1 in the mean for a true model.
  double chi2_per_dof = 0;
  /// chi2_per_dof that chance exceeds in about 1 of 100 for a true model; nan where there is no
  /// test.
  double chance = 0;
  /// Misfit expected on another ensemble like this one, but for a number that all models share:
  /// misfit + 2 x what the free numbers took of the noise (Takeuchi's criterion). Without a spread
  /// the misfit.
  double expected = 0;
  double rel_l2 = 0;  ///< |mean - model| / |mean|
  bool converged = false;
  std::string note;  ///< what the reader must know: bound hit, not determined, ...
  /// parameters x realizations: the best without each; empty below 3 realizations.
  Eigen::MatrixXd left_out;
  /// Other minima within the noise: constants whose misfit is above the least by less than the
  /// noise makes of it, and which differ from the best by more than their errors.
  std::vector<Eigen::VectorXd> other_minima;
  /// Constants that have another sign without one of the realizations, a clause each: "mu is -0.54,
  /// without realization 3 +0.44". Empty: none.
  std::vector<std::string> turning_signs;
};

/// Whether a describes the data better than b.
inline bool better(const Fit& a, const Fit& b) { return a.expected < b.expected; }

/// The parameters that minimise the sum of squares of (mean - model) in working units
/// (Levenberg-Marquardt, Eigen/MINPACK, from every start; bounds by a logistic map). Values outside
/// the model's domain count as 0. Throws std::invalid_argument when every value is outside, or for
/// a model without starts.
Fit fit(const FitData& data, const Weights& weights, const FitModel& model,
        const FitOptions& options = {});

/// Best parameters for a given vector of values (one per row of data): what fit() does to the mean.
/// `ends`: where the search from each start has ended.
Eigen::VectorXd best_parameters(const FitData& data, const Eigen::VectorXd& values,
                                const Weights& weights, const FitModel& model,
                                const std::vector<Eigen::VectorXd>& starts, double huber,
                                bool* converged = nullptr,
                                std::vector<Eigen::VectorXd>* ends = nullptr);

/// The model's values at the data's rows (0 outside its domain).
Eigen::VectorXd predict(const FitData& data, const FitModel& model,
                        const Eigen::VectorXd& parameters, int* outside = nullptr);

/// The fitted values in the model's order.
Eigen::VectorXd parameters_of(const Fit& fit);

}  // namespace grainfield::coupling
