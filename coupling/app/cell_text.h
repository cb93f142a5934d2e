// A periodic cell in a line.
#pragma once
#include <string>

#include "dem/space/cell.h"

namespace grainfield::coupling {

/// "periodic along x, y; edges (0.1, 0, 0) and (0, 0.1, 0) m from (0, 0, 0)", and how it flows.
std::string cell_text(const dem::Cell<3>& cell);

}  // namespace grainfield::coupling
