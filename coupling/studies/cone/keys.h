// Keys of cones and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_cone_keys(SectionKeys s);

inline constexpr KeySection kConeKeys{"cone", KeyRole::grains, declare_cone_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> cone_figures();

}  // namespace grainfield::coupling
