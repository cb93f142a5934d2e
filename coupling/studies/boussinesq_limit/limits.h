// How far the models are from the grains beyond the noise, by region and width of averaging.
#pragma once
#include <string>
#include <vector>

#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// Adds limit.MODEL.REGION.WIDTH.* of the result's comparison.
void add_limits(StudyResult& result);
std::vector<SummaryKey> limit_keys();
/// To what share each model is right on the base, where the bound is low enough to say so.
std::string told_limits(const StudyResult& result);

}  // namespace grainfield::coupling
