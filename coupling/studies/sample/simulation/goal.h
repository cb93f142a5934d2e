// Whether a sample's compression and its rest have reached what they are for.
#pragma once
#include "coupling/studies/sample/simulation/path.h"
#include "dem/engine/engine.h"

namespace grainfield::dem {

/// More than grains can fill: they would be inside each other.
inline constexpr double kTooDense = 1.3;

/// The key of [sample] that ends the compression: "pressure".
const char* goal_key(const SamplePlan& plan);

/// Share of its target that a compression to a strain or a solid fraction has reached. `box`: the
/// last edge when the grains were placed, m.
double compressed_share(const SamplePlan& plan, double last_edge, double box, double fraction);

/// All pressures that servos hold are near their target: what is left comes in the rest.
bool is_near_pressure(const SamplePlan& plan, const Vec3& pressure);
/// Throws ComputationFailed: `time` s have passed without that, or the grains are inside each
/// other.
void check_pressure_found(const SampleSetup& setup, double time, double compression_time,
                          double fraction);

/// Throws ComputationFailed: grains are pressed flat, into each other or a wall by half a radius.
/// `when`: "at a strain of 0.3", "after the compression"; `key`: what has brought them there.
void check_not_crushed(const SampleSetup& setup, const Diagnostics& state, const std::string& when,
                       const char* key);
/// Throws ComputationFailed: a compression to a solid fraction begins beyond it.
void check_fraction_ahead(const SamplePlan& plan, double fraction);

/// Largest relative error of what servos hold in a phase.
double servo_error(const SamplePlan& plan, SamplePhase phase, const Vec3& pressure);
/// At rest, and servos hold what they should.
bool is_prepared(const SampleSetup& setup, SamplePhase phase, const Diagnostics& state,
                 const Vec3& pressure);
/// Throws ComputationFailed: that has not come within rest.max_time, and why.
[[noreturn]] void fail_to_prepare(const SampleSetup& setup, const Diagnostics& state,
                                  const Vec3& pressure);

}  // namespace grainfield::dem
