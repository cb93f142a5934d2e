// The figures of Wellmann, Lillie and Wriggers that samples of superellipsoids are measured
// against.
#pragma once
#include <vector>

#include "coupling/reproduce/figures.h"

namespace grainfield::coupling {

std::vector<SourceFigure> box_figures();

}  // namespace grainfield::coupling
