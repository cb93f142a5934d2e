// The case's models beside cones.
#pragma once
#include "coupling/run/study_result.h"
#include "coupling/studies/cone/cone_ensemble.h"
#include "coupling/studies/cone/page.h"

namespace grainfield::coupling {

/// Throws std::invalid_argument "compare.models: ..." for a model of another problem than a heap
/// under its weight, naming those that fit.
void check_cone_models(const Case& value);

/// The models' fields, figures and maps, the comparison and its figures; a warning where the
/// models' cone is another body than the heap.
void compare_cones(const ConeEnsemble& cones, StudyResult& out, ConePage& page);

}  // namespace grainfield::coupling
