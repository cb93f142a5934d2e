// Keys that every study has: the study, the ensemble of its grains, models, output, sweep.
#pragma once
#include <vector>

#include "coupling/case/keys.h"

namespace grainfield::coupling {

/// The top level and [ensemble].
void declare_first_keys(std::vector<Key>& keys);
/// [compare], [output] and [sweep].
void declare_last_keys(std::vector<Key>& keys);

}  // namespace grainfield::coupling
