// What grains or a measurement say of models: the one result of comparisons and fits. judge.h makes
// it, words.h says it, and every output shows it.
//
// Four words have one meaning everywhere (docs/glossary.md):
//   nearest           smallest difference on realizations left out; the first of `models`
//   agrees            misfit (statistics/agreement.h) within what chance makes of a true model's
//   distinguishable   behind the nearest by more than chance
//   supported         agrees, and cannot be distinguished from the nearest
#pragma once
#include <string>
#include <vector>

#include "continuum/constants.h"

namespace grainfield::coupling {

/// Where errors come from.
enum class ErrorsFrom {
  realizations,  ///< the spread of two or more
  data,          ///< standard errors of the mean that came with it
  nothing        ///< one realization, or all are equal
};

/// Yes, no, or unknown because there are no errors.
enum class Answer { unknown, no, yes };
/// "unknown", "no", "yes".
const char* text_of(Answer answer);

/// Share of ensembles whose Power::least and most hold the true number.
inline constexpr double kForesight = 0.8;

/// How many realizations would distinguish a model from the best at 95 % with a power of 80 %. As
/// often too many as too few; least and most hold the true number in kForesight of ensembles.
struct Power {
  double realizations = kNan, least = kNan, most = kNan;  ///< infinite: none is foreseen
  bool same = false;  ///< no number would: the two are one stress here
  /// What it follows from: score less that of the best model, and its standard error.
  double difference = kNan, error = kNan;
};

/// Differences are shares of the mean's own sum of squares, |model - grains|^2 / |grains|^2, in
/// working units.
struct JudgedModel {
  std::string name;       ///< for summary keys
  std::string label;      ///< for people
  std::string family;     ///< "finite layer"; empty: the model is the only one of its family
  std::string equations;  ///< "elliptic" or "hyperbolic"; empty: nothing is said of it
  int free = 0;           ///< numbers that were fitted and that the data determine
  /// Models that are special cases of it, which it cannot outbid.
  std::vector<std::string> special_cases;
  /// Constants without equilibrium: listed, but it wins no verdict.
  bool description = false;

  double misfit = kNan;  ///< squared, over what the errors make of a true model's: 1 in the mean
  double chance = kNan;  ///< the misfit that a true model exceeds in 1 of 100 ensembles
  double values = kNan;  ///< independent ones behind the misfit
  double rel_l2 = kNan;  ///< |grains - model| / |grains|

  double score = kNan;         ///< mean squared difference on realizations left out
  double behind = kNan;        ///< score less that of the nearest
  double behind_error = kNan;  ///< its standard error, paired over realizations
  double heights_behind = kNan, heights_error = kNan;  ///< the same on heights left out
  /// For a single field with errors: Akaike's difference to the nearest, where numbers are free.
  double aic_behind = kNan;

  bool nearest = false;                      ///< the one that the others are compared with
  Answer distinguishable = Answer::unknown;  ///< from the nearest; no for itself
  Power power;                               ///< against the best model; nan for itself

  Answer agrees() const;
  Answer supported() const;
  /// "yes", "no", "unknown", or "reference": it is the nearest, and there are errors.
  const char* distinguishable_text() const;
};

/// Where the data are between the best models of two families.
struct Position {
  std::string from, to;               ///< families: 0 and 1; empty: there is one family
  double value = kNan, error = kNan;  ///< standard error
};

/// The judgement through an averaging kernel of another width.
struct AtWidth {
  double diameters = 0;  ///< width in mean grain diameters
  std::string best;
  Answer distinguishable = Answer::unknown, agrees = Answer::unknown;
  std::string why;  ///< there is none, for this reason; empty: there is one
};

struct Judgement {
  /// Nearest first; before them those that cannot be distinguished from it.
  std::vector<JudgedModel> models;
  /// Fewest free numbers among the models that cannot be distinguished from the nearest; the
  /// nearest of equals. Without errors the nearest.
  std::string best;
  /// Every other model is distinguishable from `best`, of its family, or contains it.
  Answer distinguishable = Answer::unknown;
  /// Equations of the models that cannot be distinguished, or "not distinguishable".
  std::string equations;
  Position position;
  /// The nearest model of another family that does not contain the best; empty: there is none.
  std::string rival;

  ErrorsFrom errors_from = ErrorsFrom::nothing;
  int realizations = 1;
  bool equal = false;     ///< all realizations are copies of one
  bool measured = false;  ///< in a laboratory: words speak of no grains
  std::string noun = "realization";

  std::vector<AtWidth> widths;  ///< kernel widths at which it was repeated; may be empty

  std::vector<std::string> findings;  ///< of the study, said before what is said of models
  std::vector<std::string> doubts;    ///< a sentence each, with what to do
  std::vector<std::string> notes;     ///< a sentence each, below the table

  /// The model `best`. Throws std::logic_error without models.
  const JudgedModel& best_model() const;
  /// The model of this name, or null.
  const JudgedModel* find(const std::string& name) const;
};

}  // namespace grainfield::coupling
