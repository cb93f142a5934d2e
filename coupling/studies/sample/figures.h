// Figures of samples.
#pragma once
#include <vector>

#include "coupling/output/summary_key.h"

namespace grainfield::coupling {

/// Their keys in summary.json.
std::vector<SummaryKey> sample_figures();

}  // namespace grainfield::coupling
