// The section of the study wedge, and its figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_wedge_keys(SectionKeys s);

inline constexpr KeySection kWedgeKeys{"wedge", KeyRole::analysis, declare_wedge_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> wedge_figures();

}  // namespace grainfield::coupling
