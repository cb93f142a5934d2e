// The load of a layer by Newton's method, in the plane and in space.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "coupling/studies/point_load/simulation.h"
#include "dem/run/common.h"
#include "dem/run/run.h"

namespace grainfield::dem {

/// A layer under its load, and what the solver reached.
struct LoadedLayer {
  Snapshot state;
  Reached reached;
};

/// `force` on its grain and on those `beside`. `go_on` is asked with the share of the load that is
/// done (empty: never); where it says no there is no result. Throws ComputationFailed naming
/// load.force or, in space where it decides, load.weights.
std::optional<LoadedLayer> load_by_newton(const Snapshot& unloaded, const EngineSettings& settings,
                                          const LoadSetup& load, const AppliedForce& force,
                                          const std::vector<std::int64_t>& beside,
                                          const std::function<bool(double)>& go_on);

/// Diagnostics of a state that no engine made, by a step so short that nothing moves.
Diagnostics diagnostics_of(const Snapshot& state, const EngineSettings& settings);

}  // namespace grainfield::dem
