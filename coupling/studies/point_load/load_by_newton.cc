#include "coupling/studies/point_load/load_by_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "coupling/studies/point_load/simulation.h"
#include "dem/quasistatic/quasistatic.h"

namespace grainfield::dem {
namespace {

constexpr double kNoTime = 1e-15;  // s
// The solver is asked for this share of the ratio at which a layer is at rest: time steps go on
// from its state, and find it at rest too.
constexpr double kRestShare = 0.1;
constexpr double kLeastRatio = 1e-12;  // that the solver takes
// Share of the forces that an engine may find left where the solver has found rest: it seeks the
// common normals of superellipsoids less far (2e-6 was found) than the solver, to the last digits.
constexpr double kLeftByNormals = 1e-5;

/// Ratio, steps and iterations of the solver.
Reached reached_by(const QuasistaticResult& r) {
  return {r.unbalanced_force_ratio, static_cast<double>(r.steps),
          static_cast<double>(r.iterations)};
}

}  // namespace

std::optional<LayerByNewton> rest_by_newton(const Snapshot& near, const EngineSettings& settings,
                                            const RestSetup& rest,
                                            const std::function<bool(double)>& go_on) {
  QuasistaticSettings how;
  how.unbalanced_force_ratio = std::max(kLeastRatio, kRestShare * rest.unbalanced_force_ratio);
  how.least_step = 1;  // there is no change to be made in steps
  how.go_on = go_on;
  try {
    QuasistaticResult r = relax(near, settings, near.gravity, {}, how);
    RestSetup seen = rest;
    if (settings.shape == ShapeKind::superellipsoid)
      seen.unbalanced_force_ratio = std::max(kLeftByNormals, rest.unbalanced_force_ratio);
    if (!at_rest(diagnostics_of(r.state, settings), seen)) return std::nullopt;
    const Reached reached = reached_by(r);
    return LayerByNewton{std::move(r.state), reached};
  } catch (const ComputationFailed&) {
    return std::nullopt;
  }
}

std::optional<LayerByNewton> load_by_newton(const Snapshot& unloaded,
                                            const EngineSettings& settings, const LoadSetup& load,
                                            const AppliedForce& force,
                                            const std::vector<std::int64_t>& beside,
                                            const std::function<bool(double)>& go_on) {
  QuasistaticSettings how;
  how.unbalanced_force_ratio = load.unbalanced_force_ratio;
  how.go_on = go_on;
  try {
    QuasistaticResult r = relax(unloaded, settings, unloaded.gravity, force, how, beside);
    r.state.attributes["state"] = "loaded";
    const Reached reached = reached_by(r);
    return LayerByNewton{std::move(r.state), reached};
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
