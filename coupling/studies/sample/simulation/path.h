// The path of a sample: its phases, what servos hold in them, and the strain that is imposed.
#pragma once
#include "coupling/studies/sample/simulation/setup.h"

namespace grainfield::dem {

/// (drop) -> (compress -> rest) -> (probe_prepared) -> (precompress (-> settle)) -> (probe_first)
/// -> deform -> (unload) -> done; those in brackets where the plan asks for them.
enum class SamplePhase : int {
  drop,
  compress,
  rest,
  probe_prepared,
  precompress,
  settle,
  probe_first,
  deform,
  unload,
  done
};

inline bool is_periodic(const SamplePlan& p) { return p.boundary == "periodic"; }
inline bool compresses_to_pressure(const SamplePlan& p) { return p.compress_to == "pressure"; }
/// Whether the first state follows the filling without a compression and a rest.
inline bool starts_as_filled(const SamplePlan& p) { return p.compress_to == "none"; }
inline bool shears(const SamplePlan& p) { return p.deformation == "simple_shear"; }
/// Whether sides turn with the lid.
inline bool tilts(const SamplePlan& p) {
  return shears(p) && !is_periodic(p) && p.sides == "tilting";
}
/// An unloading to a stress ends at this share of the largest axial stress at the latest: what
/// begins without stress would be unloaded until the last grain has left the lid.
inline constexpr double kLeastUnloaded = 1e-3;
inline bool unloads(const SamplePlan& p) { return p.unload != "none"; }
inline bool has_other_friction(const SamplePlan& p) { return p.prepared_with == "other_friction"; }
/// Whether it is shortened along the last axis, and rests once more, before the first state.
inline bool precompresses(const SamplePlan& p) { return p.precompression > 0; }
/// The deformation goes on, forwards or back.
inline bool deforms(SamplePhase phase) {
  return phase == SamplePhase::deform || phase == SamplePhase::unload;
}
/// Small strains are tried at rest after the preparation, or in the first state.
inline bool probes(SamplePhase phase) {
  return phase == SamplePhase::probe_prepared || phase == SamplePhase::probe_first;
}
inline bool probes_prepared(const SamplePlan& p) {
  return p.probe == "prepared" || p.probe == "both";
}
inline bool probes_first(const SamplePlan& p) { return p.probe == "first" || p.probe == "both"; }
/// Recorded states, the first one included.
inline int states_of(const SamplePlan& p) {
  return p.records + 1 + (unloads(p) ? p.unload_records : 0);
}

/// Whether the axis' edge changes in the compression.
bool compresses(const SamplePlan& plan, int axis);
/// Whether a servo holds the stress across the axis in a phase, or across any.
bool is_led(const SamplePlan& plan, SamplePhase phase, int axis);
bool any_led(const SamplePlan& plan, SamplePhase phase);

/// Strain that is imposed until `time` s after a motion's start: between walls the rate rises
/// smoothly (3 s^2 - 2 s^3) within ramp_time.
double strain_at(const SamplePlan& plan, double time);
/// Steps until it is reached.
long steps_to(const SamplePlan& plan, double strain, double time_step);
/// Strain against the first state, `time` s after the beginning of deform or unload, which begins
/// at what whole steps have reached.
double strain_in(const SamplePlan& plan, SamplePhase phase, double time, double time_step);

}  // namespace grainfield::dem
