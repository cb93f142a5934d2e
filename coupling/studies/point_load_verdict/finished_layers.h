// Loaded layers of earlier runs, as a new run finds them.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "coupling/case/case.h"
#include "dem/study/run.h"

namespace grainfield::coupling {

/// Layer `number` of grains.files: every group of these files that holds the snapshots "unloaded"
/// and "loaded", in the order of files and groups. The run is done from the start; its result holds
/// both, and figures that follow from them. Throws std::invalid_argument "grains.files: ..." for a
/// file without such a group or too few for ensemble.realizations, "load.force: ..." when the
/// layer carries another force.
std::unique_ptr<dem::Run> make_finished_layer_run(const Case& value, std::int64_t number);
/// Reads all of them (try_finished_runs). Throws the same.
void try_finished_layers(const Case& value);
/// Of them, unused_runs().
std::string unused_layers(const Case& value);

}  // namespace grainfield::coupling
