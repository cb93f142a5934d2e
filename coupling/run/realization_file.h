// A finished realization in one HDF5 file: groups /unloaded and /loaded; the figures are attributes
// of /loaded, named "figure:NAME", with all their digits.
#pragma once
#include <string>

#include "coupling/run/ensemble.h"
#include "dem/study/run.h"

namespace grainfield::coupling {

/// Complete or not at all.
void write_realization(const std::string& file, const dem::RunResult& result);

}  // namespace grainfield::coupling
