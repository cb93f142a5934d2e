// Sections that the studies of loaded layers share, and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_packing_keys(SectionKeys s);
void declare_load_keys(SectionKeys s);

inline constexpr KeySection kPackingKeys{"packing", KeyRole::grains, declare_packing_keys};
inline constexpr KeySection kLoadKeys{"load", KeyRole::grains, declare_load_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> point_load_figures();

}  // namespace grainfield::coupling
