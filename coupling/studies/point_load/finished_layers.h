// Layers that an earlier run loaded (grains.files), in place of building them again.
#pragma once
#include <cstdint>
#include <memory>

#include "coupling/case/case.h"
#include "coupling/run/finished_runs.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"

namespace grainfield::coupling {

/// Names of the snapshots of a loaded layer, and the study that leaves them.
inline const std::vector<std::string> kLayerStates{"unloaded", "loaded"};
inline constexpr const char* kLayerStudy = "point-load";

/// The realization of that number, from grains.files where the case has any, otherwise built.
/// Throws std::invalid_argument "load.force: ..." for layers under another load.
std::unique_ptr<dem::Run> make_layer(const Case& value, std::int64_t number, int threads);
/// Throws std::invalid_argument "material.KEY: ..." where a finished layer has another gravity,
/// density or friction.
void require_same_material(const dem::MaterialSetup& asked, const dem::Snapshot& layer,
                           const FinishedRun& place);
/// Study::foresee of such a case.
dem::Outlook foresee_layer(const Case& value, std::int64_t draws);

}  // namespace grainfield::coupling
