#include "coupling/studies/point_load/load_by_newton.h"

#include <fmt/format.h>

#include "coupling/studies/point_load/simulation.h"
#include "dem/quasistatic/quasistatic.h"

namespace grainfield::dem {
namespace {

constexpr double kNoTime = 1e-15;  // s

}  // namespace

std::optional<LoadedLayer> load_by_newton(const Snapshot& unloaded, const EngineSettings& settings,
                                          const LoadSetup& load, const AppliedForce& force,
                                          const std::vector<std::int64_t>& beside,
                                          const std::function<bool(double)>& go_on) {
  QuasistaticSettings how;
  how.unbalanced_force_ratio = load.unbalanced_force_ratio;
  how.go_on = go_on;
  try {
    QuasistaticResult r = relax(unloaded, settings, unloaded.gravity, force, how, beside);
    r.state.attributes["state"] = "loaded";
    return LoadedLayer{std::move(r.state),
                       {r.unbalanced_force_ratio, static_cast<double>(r.steps),
                        static_cast<double>(r.iterations)}};
  } catch (const RelaxationStopped&) {
    return std::nullopt;
  } catch (const ComputationFailed& failure) {
    const bool by_weights = unloaded.dim == 3 && load.weights > 0;
    const char* key = by_weights ? "load.weights" : "load.force";
    throw ComputationFailed(fmt::format(
        "{} = {:g}: {}; or set load.method = damped, or a smaller {}", key,
        by_weights
            ? load.weights
            : std::hypot(force.fx, force.fy, force.fz) * static_cast<double>(1 + beside.size()),
        failure.what(), key));
  }
}

Diagnostics diagnostics_of(const Snapshot& state, const EngineSettings& settings) {
  EngineSettings short_step = settings;
  short_step.time_step = kNoTime;
  const auto engine = make_engine(short_step, state);
  engine->step(1);
  return engine->measure();
}

}  // namespace grainfield::dem
