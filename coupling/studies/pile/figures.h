// Figures of piles.
#pragma once
#include <vector>

#include "coupling/output/summary_key.h"

namespace grainfield::coupling {

/// Their keys in summary.json.
std::vector<SummaryKey> pile_figures();

}  // namespace grainfield::coupling
