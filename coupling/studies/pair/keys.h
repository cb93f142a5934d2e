// The section of two bodies that meet, and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_pair_keys(SectionKeys s);

inline constexpr KeySection kPairKeys{"pair", KeyRole::grains, declare_pair_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> pair_figures();

}  // namespace grainfield::coupling
