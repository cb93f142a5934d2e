// The report of a pile.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/compare/compare.h"
#include "coupling/fit/ensemble_fit.h"
#include "coupling/report/report.h"
#include "coupling/run/study_result.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct PileReport {
  std::string title, subtitle;
  const dem::Snapshot* pile = nullptr;  ///< of the realization that is drawn; may be null
  /// The same pile under changed gravity: label ("g = 8.829 m/s2"), snapshot.
  std::vector<std::pair<std::string, const dem::Snapshot*>> changed;
  /// Profile "base" and horizontal cuts in units of comparison.scale; `beside`
  /// holds other averages of the base ("base_METHOD").
  Comparison comparison;
  Field map;             ///< scaled to comparison's h and rho g h, heap's frame; may be empty
  std::string averaged;  ///< how, for captions: "coarse graining, lucy kernel, w = 0.0055 m"
  Table changes;         ///< what each changed gravity did; without rows: left out
  std::optional<Picture> beside;                  ///< measured base forces and the grains'
  std::vector<Section> fit_pictures, fit_tables;  ///< of models with free constants; may be empty
  ReportRows figures, made;
};

Report pile_report(const PileReport& input);

/// Fits of models to piles, and the piles' own lines, which stay on the page.
struct FittedPiles {
  std::shared_ptr<const EnsembleFits> fits;
  Comparison piles;
};

/// What the page of a result has besides it.
struct PilePageFacts {
  std::string averaged;                 ///< as of PileReport
  std::string flat;                     ///< which flanks no line fits; empty: none
  std::optional<Chart> beside;          ///< measured base forces and the grains'
  const FittedPiles* fitted = nullptr;  ///< may be null
};
/// `first`: may be null.
Report pile_page(const StudyResult& result, const Realization* first, const PilePageFacts& facts);

}  // namespace grainfield::coupling
