// Generalised least squares of one model on one ensemble.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "coupling/fit/covariance.h"
#include "coupling/fit/data.h"
#include "coupling/fit/model.h"

namespace grainfield::coupling {

struct FitOptions {
  /// Huber's weights on the whitened residuals: one in the wrong region pulls no more than this
  /// many errors' worth; 0: plain least squares.
  double huber = 0;
  int bootstrap = 200;     ///< draws of realizations; 0: none
  bool jackknife = true;   ///< every realization left out once, where there are three or more
  bool profile = true;     ///< intervals by the profile of chi squared
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
  double covariance_error = 0;  ///< sqrt of (J^T W^T W J)^-1
  double bootstrap_error = 0;   ///< standard deviation over draws of the realizations; nan without
  double jackknife_error = 0;   ///< over realizations left out; nan below 3
  double low = 0, high = 0;     ///< interval of `level` that is quoted: that of `error`
  /// The same from each error, value +- Student's t times it, t of realizations - 1 degrees of
  /// freedom; and where the least chi squared with this parameter held is t^2 above the least.
  Interval by_covariance, by_bootstrap, by_jackknife, by_profile;
  bool at_bound = false;   ///< the search ended at the parameter's bound: no error
  bool determined = true;  ///< false: the values do not depend on it, or on it with others alone
};

struct Fit {
  std::string name, label;
  std::vector<FittedParameter> parameters;
  Eigen::MatrixXd correlation;  ///< of the parameters, from the covariance
  Eigen::VectorXd model;        ///< values at the best parameters
  Eigen::VectorXd residual;     ///< (mean - model) / standard error, value by value
  double chi2 = 0;              ///< |W (mean - model)|^2
  double dof = 0;               ///< effective values - parameters
  double chi2_per_dof = 0;      ///< nan for a covariance of kind "unknown"
  /// chi2_per_dof that a true model exceeds in 1.35 of 1000 (three standard deviations): of
  /// Fisher's F with dof and the covariance's degrees of freedom; nan where there is no test.
  double chance = 0;
  /// chi2 + 2 k + 2 k (k + 1) / (n - k - 1); inf for n <= k + 1; nan for a covariance of kind
  /// "unknown": chi2 has no scale then.
  double aicc = 0;
  double rel_l2 = 0;  ///< |mean - model| / |mean|
  bool converged = false;
  std::string note;  ///< what the reader must know: bound hit, not determined, ...
  /// parameters x realizations: the best without each, with a covariance of the others; empty
  /// below 3 realizations.
  Eigen::MatrixXd left_out;
  /// Other minima within the noise: constants whose chi squared is above the least by less than
  /// Student's t squared, and which differ from the best by more than their errors.
  std::vector<Eigen::VectorXd> other_minima;
  /// Constants that have another sign without one of the realizations, a clause each: "mu is -0.54,
  /// without realization 3 +0.44". Empty: none.
  std::vector<std::string> turning_signs;
};

/// Whether a describes the data better than b: by AICc, without it by relative L2.
bool better(const Fit& a, const Fit& b);

/// The parameters that minimise |W (mean - model)|^2 (Levenberg-Marquardt, Eigen/MINPACK, from
/// every start; bounds by a logistic map). Values outside the model's domain count as 0. Throws
/// std::invalid_argument when every value is outside, or for a model without starts.
Fit fit(const FitData& data, const Covariance& covariance, const FitModel& model,
        const FitOptions& options = {});

/// Best parameters for a given vector of values (one per row of data): what fit() does to the mean.
/// `ends`: where the search from each start has ended.
Eigen::VectorXd best_parameters(const FitData& data, const Eigen::VectorXd& values,
                                const Eigen::MatrixXd& whitener, const FitModel& model,
                                const std::vector<Eigen::VectorXd>& starts, double huber,
                                bool* converged = nullptr,
                                std::vector<Eigen::VectorXd>* ends = nullptr);

/// The model's values at the data's rows (0 outside its domain).
Eigen::VectorXd predict(const FitData& data, const FitModel& model,
                        const Eigen::VectorXd& parameters, int* outside = nullptr);

}  // namespace grainfield::coupling
