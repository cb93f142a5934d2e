// What fits of heaps leave, from their data to a result that is written.
#pragma once
#include <functional>
#include <memory>

#include "coupling/fit/ensemble_fit.h"
#include "coupling/observe/observations.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

struct HeapResult {
  StudyResult study;
  std::shared_ptr<const EnsembleFits> fits;
};

/// Fits, tables, summary keys and page. `value`: name, title and fit of the case count. `drawn`: a
/// heap for the page where no realization is at hand; called while the page is made; may be empty.
/// `observe`: the heaps with another [fit], for fit.kernel; may be empty without it. Throws as
/// fit_heaps.
HeapResult heap_result(const Case& value, Observations heaps, int threads,
                       const std::function<Observations(const FitSetup&)>& observe,
                       std::function<dem::Snapshot()> drawn = nullptr);

}  // namespace grainfield::coupling
