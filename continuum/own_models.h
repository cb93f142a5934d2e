// Models that are added while the program runs, such as a function of Python, beside the
// registry's.
#pragma once
#include "continuum/model.h"

namespace grainfield::continuum {

/// Adds a model to registry(), or puts it in the place of the one that was added under its name.
/// Not while models are made or evaluated: find_model() returns references. Throws BadParameter for
/// the name of a model that was not added here, and for one of other characters than letters,
/// digits and _.
void add_own_model(ModelInfo info);

}  // namespace grainfield::continuum
