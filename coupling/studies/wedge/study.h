// Elastic-plastic heaps beside the closed wedges, without grains: how they were laid, their
// dilation and their base against what presses on the base.
#pragma once
#include "coupling/case/case.h"
#include "coupling/case/study.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// Evaluates the case's models on horizontal lines through the heap. Where [wedge] lists histories,
/// dilations or bases, every finite-element heap of the case is solved for all their combinations,
/// and one without equilibrium is an entry of the table; else it fails the study. Throws what
/// models throw, and std::invalid_argument for fewer than two models or no finite-element heap.
StudyResult analyse_wedge(const Case& value);

Study wedge_study();

}  // namespace grainfield::coupling
