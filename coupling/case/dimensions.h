// Keys and words that hold in two or in three dimensions only.
#pragma once
#include "coupling/case/apply.h"

namespace grainfield::coupling {

/// Throws std::invalid_argument "ORIGIN: KEY: found ..., allowed: ..." for a key or a word, written
/// or standing by default, that does not hold in the dimensions of the case's grains.
void check_dimensions(const Draft& draft);

}  // namespace grainfield::coupling
