// Parts that the studies of loaded layers share.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

/// Its sections are those of grains, load and averages; and it says what models are told of them.
Study layer_study();

/// Throws std::invalid_argument where load.force is given in space beside load.weights, which
/// counts.
void check_one_load(const Case& value);

}  // namespace grainfield::coupling
