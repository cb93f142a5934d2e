// Which models the data support: the one judge of comparisons and fits. A comparison is a fit with
// nothing free.
//
// Two tests that can disagree. The first predicts realizations: constants from all but one, scored
// on that one by its squared difference in working units, which are fixed and hold nothing of it.
// The second predicts heights: constants from the other heights of all realizations, scored on the
// height left out, realization by realization. Differences between two models are paired over the
// realizations, so that what the realizations share drops out; their errors have Student's t with
// as many degrees of freedom as realizations less one. (AICc of all data is the first test once
// more, without its error.)
//
// A model is distinguishable from the nearest when it is behind by more than chance in the first
// test and the second does not have it ahead:
//   behind > t error,   heights behind >= 0.
// With nothing free the data are then beyond the middle between both models by more than t standard
// errors. These must be less than the models' distance, |model - nearest|^2 > t error / 2: models
// that are given may be nearer to each other than the data are to either. A model that is at least
// as far behind in both tests as a distinguishable one is distinguishable too: a larger deficit
// with a larger error is no better support than a smaller one.
//
// The constants of a single field with errors are fitted to the very noise that judges them. There
// a model must be behind in Akaike's criterion too, chi2 + 2 x free numbers with these errors, by
// more than 10 (Burnham and Anderson 2002, 2.6: essentially no support).
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "coupling/judge/judgement.h"

namespace grainfield::coupling {

/// What is judged by, in working units.
struct Evidence {
  Eigen::MatrixXd samples;  ///< values x realizations; one column: the mean alone
  Eigen::VectorXd error;    ///< of the mean; used with ErrorsFrom::data alone
  double tied = 1;          ///< as many values as count for one there
  ErrorsFrom errors_from = ErrorsFrom::nothing;
  int realizations = 1;  ///< behind the mean
};

struct Candidate {
  /// All but score, differences and answers, which the judge fills in.
  JudgedModel model;
  /// What every realization is held against: values x realizations; one column serves all.
  Eigen::MatrixXd forecast;
  Eigen::VectorXd heights;  ///< predicted from the other heights; empty: nothing is left out
  double taken = 0;         ///< what its constants took of a single field's noise, squared
  double akaike = kNan;     ///< of a single field with errors
};

/// What aic_behind counts as behind.
inline constexpr double kNoSupport = 10;

/// Differences below this share of the field's square are those of rounding and of the solver's
/// tolerance: two models that are one field here (bcc and cantelaube_zero) are not distinguishable.
inline constexpr double kSame = 1e-7;

/// Student's t, 95 %, two-sided, over so many realizations; infinite below 3; of 1 (errors known)
/// the normal quantile.
double least_errors(int realizations);

/// Fills `distinguishable` of models with their differences to the nearest, which is the first.
/// `apart`: |model - nearest|^2, in the same unit, one per model; infinite where numbers are free.
void mark_distinguishable(std::vector<JudgedModel>& models, const std::vector<double>& apart,
                          double least_errors);

/// Ranks the candidates. Without errors, or with fewer than 3 realizations, by relative L2, and
/// nothing is distinguishable. Throws std::invalid_argument without candidates.
Judgement judge(const Evidence& evidence, std::vector<Candidate> candidates);

/// Judges again at each of these kernel widths, mean grain diameters, and fills judgement.widths.
/// `again` throws std::invalid_argument where a width leaves too few values.
void judge_at_widths(const std::vector<double>& diameters,
                     const std::function<Judgement(double)>& again, Judgement& judgement);

}  // namespace grainfield::coupling
