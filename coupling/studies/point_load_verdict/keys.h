// The section of fits to layers.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_verdict_keys(SectionKeys s);

inline constexpr KeySection kVerdictKeys{"verdict", KeyRole::analysis, declare_verdict_keys};

}  // namespace grainfield::coupling
