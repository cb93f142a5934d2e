// A finite-element model against its closed form, without grains.
#pragma once
#include "coupling/case/case.h"
#include "coupling/case/study.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// Evaluates the case's models of the study's dimension at its points. The first model takes the
/// place of the simulation in the tables; the others are compared with it. Throws what models
/// throw, and std::invalid_argument for fewer than two models of this dimension.
StudyResult analyse_elastic(const Case& value);

Study elastic_layer_study();
Study orthotropic_layer_study();
Study elastic_half_space_study();
Study wedge_core_study();

}  // namespace grainfield::coupling
