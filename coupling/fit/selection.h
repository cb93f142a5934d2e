// Which of several fitted models the data support.
//
// Two independent judges: AICc on all data, and cross-validation: parameters from some realizations
// (or from some heights), scored on those left out by the whitened squared difference. A model wins
// when it is ahead of the runner-up in AICc by more than `least_aicc` and in the cross-validation
// beyond the standard error of the difference over the parts left out (Student's t, 95 %). A model
// that is so far behind the best is not supported, nor is any that is at least as far behind in
// both: a larger deficit with a larger error is no better support than a smaller one. The rest are
// "not distinguishable".
#pragma once
#include <string>
#include <vector>

#include "coupling/fit/fit.h"

namespace grainfield::coupling {

struct SelectionOptions {
  double least_aicc = 6;  ///< Burnham and Anderson 2002: little support above 4 to 7
  double huber = 0;       ///< as FitOptions
  bool by_level = true;   ///< leaves out levels too, where there are two or more
};

struct Score {
  std::string name;
  double aicc_difference = 0;    ///< from the best; nan with one realization
  double realization_score = 0;  ///< mean over the realizations left out of the squared difference
                                 ///< per effective value; nan below 3 realizations
  double level_score = 0;        ///< the same over the levels left out; nan below 2 levels
  double behind = 0;             ///< mean difference of realization_score to the best
  double behind_error = 0;       ///< its standard error over the realizations
  bool supported = false;        ///< see above
};

/// Sets `supported` of scores with their differences to the best, which is the first: see above;
/// `least_errors`: standard errors that count as behind. Without cross-validation (behind nan) all
/// are supported.
void mark_supported(std::vector<Score>& ranking, double least_aicc, double least_errors);

/// Student's t, 95 %, two-sided, of the difference over so many realizations left out; infinite
/// below 3.
double least_errors(int realizations);

struct Selection {
  /// The supported ones first, each part by AICc; with one realization by relative L2.
  std::vector<Score> ranking;
  bool distinguishable = false;
  std::string sentence;  ///< for people, one line
};

/// Ranks the models. `fits`: of the same data and covariance, in the order of `models`. Throws
/// std::invalid_argument for no model or sizes that differ.
Selection select(const FitData& data, const Covariance& covariance,
                 const std::vector<FitModel>& models, const std::vector<Fit>& fits,
                 const SelectionOptions& options = {});

}  // namespace grainfield::coupling
