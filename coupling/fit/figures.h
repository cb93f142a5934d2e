// Figures of fits of models, to heaps and layers alike.
#pragma once
#include <vector>

#include "coupling/output/figure.h"

namespace grainfield::coupling {

/// Their keys in summary.json.
std::vector<SummaryKey> figures_of_fits();

}  // namespace grainfield::coupling
