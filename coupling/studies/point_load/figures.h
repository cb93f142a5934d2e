// Figures of loaded layers.
#pragma once
#include <vector>

#include "coupling/output/summary_key.h"

namespace grainfield::coupling {

/// Their keys in summary.json.
std::vector<SummaryKey> point_load_figures();

}  // namespace grainfield::coupling
