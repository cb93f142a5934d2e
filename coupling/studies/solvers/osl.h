// Oriented stress linearity as a field problem against its closed forms, without grains.
#pragma once
#include "coupling/case/case.h"
#include "coupling/case/study.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// Evaluates the case's models on horizontal lines through the heap (osl-wedge) or the layer
/// (osl-layer); the first one is the reference. Throws what models throw, and
/// std::invalid_argument for fewer than two models.
StudyResult analyse_osl(const Case& value);

Study osl_wedge_study();
Study osl_layer_study();

}  // namespace grainfield::coupling
