// A sample of grains under compression and shear, as a resumable run.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "coupling/studies/sample/simulation/setup.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Snapshots "state_000" (at rest, compressed) to "state_NNN" with NNN = plan.records, at equal
/// steps of strain; then those of the unloading, at equal steps of strain or of the axial stress.
/// Attributes of each, as numbers: strain (imposed), kinetic_energy,
/// elastic_energy, work (of cell and walls since the beginning), unbalanced_force_ratio,
/// strain_rate; with motion.energy_balance lost_in_dashpots, lost_to_friction, lost_to_rolling,
/// lost_to_damping, work_of_law and energy_balance since the beginning. Figure
/// "sample.stress_error": largest relative error of a servo during the deformation, at any of its
/// measurements, "sample.stress_rms_error" the root of their mean square (where there is a servo).
/// Dropped: "sample.gap_spheres" and "sample.dropped_solid_fraction", as the lid is put on.
/// Tables probes_* of "state_000": what small strains have shown (probe_record.h).
/// `filled`: a recorded state between walls that takes the place of drawing and dropping
/// (plan.filling "dropped"); then the seed is only recorded.
/// Throws std::invalid_argument naming the key that does not hold ("sample.pressure"). The bits of
/// the result do not depend on threads.
std::unique_ptr<Run> make_sample_run(const SampleSetup& setup, std::uint64_t seed, int threads,
                                     const Snapshot* filled = nullptr);

/// Throws as make_sample_run would for any of these seeds; draws at most so many polygons.
Outlook foresee_sample(const SampleSetup& setup, const std::vector<std::uint64_t>& seeds,
                       std::int64_t draws);

}  // namespace grainfield::dem
