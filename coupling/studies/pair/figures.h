// Figures of two bodies that meet.
#pragma once
#include <vector>

#include "coupling/output/summary_key.h"

namespace grainfield::coupling {

/// Their keys in summary.json.
std::vector<SummaryKey> pair_figures();

}  // namespace grainfield::coupling
