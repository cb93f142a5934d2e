// Samples of grains under compression and shear: their recorded states as tables and curves.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/case/study.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// From the finished realizations (files of run_tasks, in order): states.csv and
/// states_of_realizations.csv (coupling/studies/sample/state_table.h), the figures sample.* with
/// their spread, the report. Throws what StateTable throws.
StudyResult analyse_sample(const Case& value, const std::vector<std::string>& realizations);

Study sample_study();

}  // namespace grainfield::coupling
