// The section of piles that settle under implicit motion, and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_settling_keys(SectionKeys s);

inline constexpr KeySection kSettlingKeys{"settling", KeyRole::grains, declare_settling_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> settling_figures();

}  // namespace grainfield::coupling
