// Cones that earlier runs left.
#pragma once
#include "coupling/run/finished_runs.h"
#include "dem/study/cone.h"
#include "dem/study/run.h"

namespace grainfield::coupling {

/// The cone of a file as a run leaves it. Throws std::invalid_argument "grains.files: ..." for a
/// snapshot that is none, and as dem::check_same_cone, naming the key, where it is another one than
/// the case's.
dem::RunResult finished_cone(const FinishedRun& place, const dem::ConeSetup& setup);

}  // namespace grainfield::coupling
