// Whether a sample's compression and its rest have reached what they are for.
#pragma once
#include "dem/engine/engine.h"
#include "dem/study/sample_path.h"

namespace grainfield::dem {

/// Share of its target that a compression to a strain or a solid fraction has reached. `box`: the
/// last edge when the grains were placed, m.
double compressed_share(const SamplePlan& plan, double last_edge, double box, double fraction);

/// All pressures that servos hold are near their target: what is left comes in the rest.
bool is_near_pressure(const SamplePlan& plan, const Vec3& pressure);
/// Throws ComputationFailed: `time` s have passed without that, or the grains are inside each
/// other.
void check_pressure_found(const SampleSetup& setup, double time, double compression_time,
                          double fraction);

/// Largest relative error of what servos hold in a phase.
double servo_error(const SamplePlan& plan, SamplePhase phase, const Vec3& pressure);
/// At rest, and servos hold what they should.
bool is_prepared(const SampleSetup& setup, SamplePhase phase, const Diagnostics& state,
                 const Vec3& pressure);
/// Throws ComputationFailed: that has not come within rest.max_time, and why.
[[noreturn]] void fail_to_prepare(const SampleSetup& setup, const Diagnostics& state,
                                  const Vec3& pressure);

}  // namespace grainfield::dem
