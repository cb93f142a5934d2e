// Which of several fitted models the data support.
//
// Two judges that can disagree. The first predicts realizations: constants from all but one, scored
// on that one by its squared difference in working units, which are fixed and hold nothing of it.
// The second predicts heights: constants from the other heights of all realizations, scored on the
// height left out, realization by realization. Differences between two models are paired over the
// realizations, so that what the realizations share drops out; their errors have Student's t with
// as many degrees of freedom as realizations less one. (AICc of all data is the first judge once
// more, without its error.)
//
// A model is not supported when it is behind the best by more than chance in the first judge, and
// the second does not have it ahead; nor is any that is at least as far behind in both as one that
// is not: a larger deficit with a larger error is no better support than a smaller one. The rest
// are "not distinguishable". Of a single field with errors the differences are those of the mean,
// with the errors that came with it. Its constants are fitted to the very noise that judges them,
// so that a model must be behind in Akaike's criterion too, chi2 + 2 x free numbers with these
// errors, by more than 10 (Burnham and Anderson 2002, 2.6: essentially no support).
#pragma once
#include <string>
#include <vector>

#include "continuum/constants.h"
#include "coupling/fit/fit.h"

namespace grainfield::coupling {

struct SelectionOptions {
  double huber = 0;      ///< as FitOptions
  bool by_level = true;  ///< leaves out heights too, where there are two or more
};

/// Differences are shares of the mean field's own sum of squares, |model - grains|^2 / |grains|^2.
struct Score {
  std::string name;
  double score = 0;           ///< first judge: mean squared difference; nan without errors
  double behind = 0;          ///< its difference to the best model's
  double behind_error = 0;    ///< standard error of that
  double heights_behind = 0;  ///< second judge: difference to the best model's; nan below 2 heights
  double heights_error = 0;   ///< standard error of that
  double aic_behind = kNan;   ///< of a single field with errors: Akaike's difference to the best
  bool supported = false;     ///< see above; what outputs say of the model is its standing()
};

/// What aic_behind counts as behind.
inline constexpr double kNoSupport = 10;

/// Differences below this share of the field's square are those of rounding and of the solver's
/// tolerance: two models that are one field here (bcc and cantelaube_zero) are not told apart.
inline constexpr double kSame = 1e-7;

/// Sets `supported` of scores with their differences to the best, which is the first: see above;
/// `least_errors`: standard errors that count as behind. Without scores (behind nan) all are
/// supported.
void mark_supported(std::vector<Score>& ranking, double least_errors);

/// Student's t, 95 %, two-sided, of the difference over so many realizations left out; infinite
/// for 2; of 1 (errors known) the normal one.
double least_errors(int realizations);

struct Selection {
  /// The supported ones first, each part by the first judge; without errors by relative L2.
  std::vector<Score> ranking;
  bool distinguishable = false;
  /// For people, one line: what is supported and by which evidence, whether any model agrees within
  /// the errors, and constants whose sign hangs on one realization.
  std::string sentence;
};

/// Whether its misfit is beyond what chance makes of a true model's; false without errors.
bool disagrees(const Fit& fit);

/// What every output calls the model: "yes" (supported), "no" (behind the best by more than chance)
/// or kOnlyNearest: not behind, but it disagrees with the data, which support none such.
std::string standing(const Score& score, const Fit& fit);
inline constexpr const char* kOnlyNearest = "no, though not behind";

/// "behind by 1.2e-02 +- 3e-03 on realizations left out and by 2e-02 +- 1e-02 on heights left out";
/// of differences below kSame "the same stress here".
std::string evidence(const Score& score);

/// " The sign of osl hangs on single realizations: mu is ..." for the models named; may be empty.
std::string sign_warnings(const std::vector<Fit>& fits, const std::vector<std::string>& names);

/// Ranks the models. `fits`: of the same data and weights, in the order of `models`. Throws
/// std::invalid_argument for no model or sizes that differ.
Selection select(const FitData& data, const Weights& weights, const std::vector<FitModel>& models,
                 const std::vector<Fit>& fits, const SelectionOptions& options = {});

}  // namespace grainfield::coupling
