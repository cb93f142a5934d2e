// Rest and load of a layer by Newton's method, in the plane and in space.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "coupling/studies/point_load/simulation.h"
#include "dem/run/common.h"
#include "dem/run/run.h"

namespace grainfield::dem {

/// A layer at rest or under its load, and what the solver reached.
struct LayerByNewton {
  Snapshot state;
  Reached reached;
};

/// A layer that is near to rest, at rest as damped dynamics would have to find it (at_rest). None
/// where the solver does not converge. `go_on` is asked as below; throws RelaxationStopped where it
/// says no.
std::optional<LayerByNewton> rest_by_newton(const Snapshot& near, const EngineSettings& settings,
                                            const RestSetup& rest,
                                            const std::function<bool(double)>& go_on);

/// `force` on its grain and on those `beside`. `go_on` is asked with the share of the load that is
/// done (empty: never); where it says no there is no result. Throws ComputationFailed naming
/// load.force or, in space where it decides, load.weights.
std::optional<LayerByNewton> load_by_newton(const Snapshot& unloaded,
                                            const EngineSettings& settings, const LoadSetup& load,
                                            const AppliedForce& force,
                                            const std::vector<std::int64_t>& beside,
                                            const std::function<bool(double)>& go_on);

/// Diagnostics of a state that no engine made, by a step so short that nothing moves.
Diagnostics diagnostics_of(const Snapshot& state, const EngineSettings& settings);

}  // namespace grainfield::dem
