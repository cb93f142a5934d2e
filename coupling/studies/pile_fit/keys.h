// The section of fits to piles.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_fit_keys(SectionKeys s);

inline constexpr KeySection kFitKeys{"fit", KeyRole::analysis, declare_fit_keys};

}  // namespace grainfield::coupling
