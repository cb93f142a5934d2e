// The section of gases of hard grains, and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_gas_keys(SectionKeys s);

inline constexpr KeySection kGasKeys{"gas", KeyRole::grains, declare_gas_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> gas_figures();

}  // namespace grainfield::coupling
