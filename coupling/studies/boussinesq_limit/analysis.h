// Layers at rest, their moduli by small strains, what elasticity predicts from these, and then the
// linear response of the grains.
#pragma once
#include <string>
#include <vector>

#include "coupling/models/choice.h"
#include "coupling/observe/observations.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// Names of the moduli in figures: five of a medium with a vertical axis, two of an isotropic one.
const std::vector<std::string>& limit_constants();

/// Adds the models that follow from the layers' moduli, before it loads the layers. The models read
/// tables until remove_tables(); their copies are among result.texts.
Observations predict_and_observe(StudyResult& result, std::vector<ModelChoice>& models,
                                 int threads);
void remove_tables(const StudyResult& result);

}  // namespace grainfield::coupling
