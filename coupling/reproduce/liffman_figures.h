// The figures of Liffman, Chan and Hughes that lattice piles, tents and dropped piles are measured
// against.
#pragma once
#include <vector>

#include "coupling/reproduce/figures.h"

namespace grainfield::coupling {

std::vector<SourceFigure> liffman_figures();

}  // namespace grainfield::coupling
