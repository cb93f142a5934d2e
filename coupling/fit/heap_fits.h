// Everything that is fitted to one ensemble of heaps: the one path of study and command.
#pragma once
#include <vector>

#include "coupling/compare/compare.h"
#include "coupling/fit/heap_data.h"
#include "coupling/fit/selection.h"

namespace grainfield::coupling {

struct HeapFits {
  HeapData heaps;
  Weights weights;
  std::vector<FitModel> models;
  std::vector<Fit> fits;  ///< in the order of models
  Selection selection;
  std::vector<FitModel> absent;  ///< asked for, but there is no such field for this heap
};

/// The models of the heaps, with slopes that a part of the realizations has alone where these are
/// measured: their spread is part of the constants' errors.
std::vector<FitModel> models_of(const FitSetup& setup, const HeapData& heaps);

/// Weights, one fit per setup.models, and their ranking. The bits do not depend on threads.
/// Throws std::invalid_argument for unknown models and what data and models throw.
HeapFits fit_heaps(const FitSetup& setup, HeapData heaps, int threads);

/// Grains and fitted models along every height and component, in m and N/m of the mean heap, with
/// their distances: for profiles.*.
Comparison profiles_of(const HeapFits& fits);

}  // namespace grainfield::coupling
