// The report of a point load on a layer.
#pragma once
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

struct PointLoadReport {
  std::string title;                        ///< of the case
  const dem::Snapshot* unloaded = nullptr;  ///< of the realization that is drawn; may be null
  const dem::Snapshot* loaded = nullptr;
  Comparison comparison;         ///< profiles at depths; the one with key "base" is drawn apart
  Field base_unloaded;           ///< mean base_profile before loading; may be empty
  Field map;                     ///< mean response on a grid in the models' frame; may be empty
  std::vector<ModelMap> models;  ///< on map.points; the nearest one's residual is drawn
  const EnsembleFits* fits = nullptr;  ///< drawn in place of profiles and maps; may be null
  ReportRows figures;                  ///< results worth a table
  ReportRows made;                     ///< case, seed, version, times
};

Report point_load_report(const PointLoadReport& input);

/// That page of a result with snapshots "unloaded" and "loaded", or of models alone (`first` null).
Report layer_page(const StudyResult& result, const Realization* first);
/// The same where the models have the constants of these fits.
Report fitted_layer_page(const StudyResult& result, const Realization* first,
                         const EnsembleFits& fits);
/// What a sweep over loaded layers shows of each.
std::vector<OverviewColumn> layer_overview();

}  // namespace grainfield::coupling
