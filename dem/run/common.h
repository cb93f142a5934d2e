// What every study of grains does alike: engine settings and their time step, the criterion of
// rest, and checkpoints.
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "dem/checkpoint/checkpoint.h"
#include "dem/engine/engine.h"
#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/run/setup.h"

namespace grainfield::dem {

/// How a slow change came to rest; nan: it was not made here, or not by Newton's method.
struct Reached {
  double unbalanced_force_ratio = std::numeric_limits<double>::quiet_NaN();
  double load_steps = std::numeric_limits<double>::quiet_NaN();  ///< of Newton's method
  double iterations = std::numeric_limits<double>::quiet_NaN();  ///< its steps in all load steps
};
/// Those that are known, as PREFIX.unbalanced_force_ratio, .load_steps and .iterations.
void add_reached(const std::string& prefix, const Reached& reached,
                 std::map<std::string, double>& figures);

/// Settings of the engine, without polygons and sleeping. Throws std::invalid_argument naming the
/// key when there is no gravity or the time step is above the stable limit of these grains;
/// irregular polygons may go up to kMostOfLimit times it with Verlet, but never beyond what the
/// dashpots of round grains bear (twice their bound). A step that does not follow from the grains'
/// own limit must stay below it by `reserve`, where not all of the grains were drawn.
EngineSettings engine_settings(const MaterialSetup& material, const MotionSetup& motion,
                               const GrainExtremes& extremes, int threads, bool irregular = false,
                               double reserve = 1, ShapeKind shape = {});
/// Throws std::invalid_argument naming the key: a law to which superellipsoids cannot offer what it
/// measures, or resistance against rolling.
void check_superellipsoid_material(const MaterialSetup& material);
/// A positive number to three digits, never up: the limit that a message names must be accepted.
double round_down(double value);
/// Throws std::invalid_argument where the grains have what the quasi-static solver does not know:
/// in the plane resistance against rolling, in space some of the laws. `asked`: "KEY: found VALUE",
/// which asks for the solver; `allowed`: the value that does not.
void check_quasistatic(const std::string& asked, const char* allowed, const MaterialSetup& material,
                       const MotionSetup& motion, ShapeKind shape);
/// Calls check_quasistatic where the key says "newton" instead of "damped".
void check_method(const char* key, const std::string& method, const MaterialSetup& material,
                  const MotionSetup& motion, ShapeKind shape = ShapeKind::disk);

/// Throws std::invalid_argument naming rest.background_damping when it would take more than its
/// velocity from a grain within a time step.
void check_background_damping(const RestSetup& rest, double time_step);

/// Throws std::invalid_argument naming the key when its time, s, takes more steps than anyone waits
/// for (kMostSteps, dem/run/outlook.h).
void check_countable(const char* key, double time, double time_step);

struct Progress;
/// What the engine tells of it, `state` being what it measures now; phase and fraction are the
/// run's.
Progress progress_of(const Engine& engine, const Diagnostics& state);
/// The engine's grains as they are, with the attributes "state", "seed" and these.
Snapshot named_snapshot(const Engine& engine, const std::string& state, std::uint64_t seed,
                        const std::map<std::string, std::string>& attributes);

bool at_rest(const Diagnostics& state, const RestSetup& rest);
/// The kinetic energy is at rest; at_rest asks for the forces as well.
bool energy_at_rest(const Diagnostics& state, const RestSetup& rest);
/// How far a rest has come, in [0, 1]: on the logarithms of the unbalanced force ratio and of
/// kinetic over elastic energy, whichever is further from its goal.
double rest_progress(const Diagnostics& state, const RestSetup& rest);
/// Throws ComputationFailed: no rest within rest.max_time; `when` completes "(...)", `remedy`
/// completes "raise rest.max_time or rest.background_damping".
[[noreturn]] void fail_to_rest(const Diagnostics& state, const RestSetup& rest,
                               const std::string& when, const std::string& remedy);

/// Behind that remedy: above the stable limit the step itself may be what keeps grains moving.
std::string smaller_step(const MotionSetup& motion);

/// Keys dem.*: grains, contacts, steps and how near the state is to rest; with
/// motion.energy_balance energy.* as well.
void add_engine_figures(const Engine& engine, const Diagnostics& state,
                        std::map<std::string, double>& figures);

using NamedSnapshots = std::vector<std::pair<std::string, Snapshot>>;
/// Writes a checkpoint beside `file` and renames it: the fingerprint of the setup, the state's bits
/// and the snapshots taken so far. Throws StorageFailed.
void write_checkpoint(const std::string& file, const std::string& fingerprint,
                      const CheckpointWriter& state, const NamedSnapshots& snapshots);
/// The state's bits. Throws std::invalid_argument naming the file when it is broken, OtherSetup
/// when it has another fingerprint.
std::string read_checkpoint(const std::string& file, const std::string& fingerprint);

}  // namespace grainfield::dem
