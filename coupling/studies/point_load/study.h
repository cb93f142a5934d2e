// A point load on a layer of grains: averages, models on the same points, comparison.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/case/study.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// Averages the finished realizations (files of run_tasks, in order) and compares them with the
/// case's models. The bits do not depend on `threads`. Throws what averaging and models throw.
StudyResult analyse_point_load(const Case& value, const std::vector<std::string>& realizations,
                               int threads, const ModelEvaluator& evaluate = evaluate_model);

/// Throws std::invalid_argument, "KEY: ...", for sizes of grains that exclude each other.
void check_point_load(const Case& value);

Study point_load_study();

}  // namespace grainfield::coupling
