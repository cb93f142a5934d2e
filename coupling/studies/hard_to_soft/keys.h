// The section of hard disks that turn soft, and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_switch_keys(SectionKeys s);

inline constexpr KeySection kSwitchKeys{"switch", KeyRole::grains, declare_switch_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> switch_figures();

}  // namespace grainfield::coupling
