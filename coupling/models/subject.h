// What a model is of: a body under a load, or a heap under its own weight.
#pragma once
#include <string>
#include <vector>

#include "coupling/models/choice.h"

namespace grainfield::coupling {

enum class Subject { load, heap };

/// The model has the load F; or the weight per volume rho_g, or chi_g, and no load.
bool is_of(const continuum::ModelInfo& info, Subject subject);

/// Throws std::invalid_argument, `key: found "LABEL", ...`, for a model of another subject, with
/// the names of those of this one and of points in `dim` dimensions.
void require_subject(const std::vector<ModelChoice>& choices, Subject subject, int dim,
                     const std::string& key);

}  // namespace grainfield::coupling
