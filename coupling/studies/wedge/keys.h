// The section of the study wedge.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_wedge_keys(SectionKeys s);

inline constexpr KeySection kWedgeKeys{"wedge", KeyRole::analysis, declare_wedge_keys};

}  // namespace grainfield::coupling
