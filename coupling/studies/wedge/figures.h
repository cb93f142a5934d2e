// Figures of elastic-plastic heaps.
#pragma once
#include <vector>

#include "coupling/output/summary_key.h"

namespace grainfield::coupling {

/// Their keys in summary.json.
std::vector<SummaryKey> wedge_figures();

}  // namespace grainfield::coupling
