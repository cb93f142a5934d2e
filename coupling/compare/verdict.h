// Which family of models the grains support. Used by compare.cc only.
#pragma once
#include "coupling/compare/compare.h"

namespace grainfield::coupling {

/// Needs profiles, models and results filled in.
Verdict judge(const Comparison& comparison);

}  // namespace grainfield::coupling
