// docs/reproduction.md.
#pragma once
#include <string>

#include "coupling/reproduce/results.h"

namespace grainfield::coupling {

/// The page: every figure of the sources beside ours, and how each study was run.
std::string reproduction_page(const Results& results);

}  // namespace grainfield::coupling
