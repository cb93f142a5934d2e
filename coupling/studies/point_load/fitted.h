// Models with free constants that are fitted to the response of layers: [fit] of a point load.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// As analyse_point_load, with the models of [fit], which stand with their constants in the tables
/// and maps of the response. Throws what fit_layers throws.
StudyResult analyse_fitted_load(const Case& value, const std::vector<std::string>& realizations,
                                int threads);

}  // namespace grainfield::coupling
