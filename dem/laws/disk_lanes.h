// Pairs of disks side by side, from the bodies to their sums of forces: overlap, motion, law and
// friction by the text that one pair has (round_overlap.h, kinematics.h, the law's own).
#pragma once
#include "dem/laws/sphere_lanes.h"
#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// What the kernel expects of the engine's rows: numbers of a Body<2>, of a ForceSum<2> and of
/// a ContactForce<2>, whose first three are those of a sum; a pair's bytes, with the spring first.
inline constexpr int kDiskBody = 8, kDiskSum = 4, kDiskForce = 4, kDiskPair = 16;

/// Where the engine has what is read and written.
struct DiskRows {
  const double* bodies = nullptr;
  unsigned char* pairs = nullptr;
  double* sums = nullptr;
  double* kept = nullptr;  ///< by pair, ContactForce<2> that are 0: these, not the sums
};

/// Their forces in a step of dt > 0, s, added to the sums of both grains in the order of the pairs.
/// The bits do not depend on W.
template <int W, class Law>
void disk_forces_of(const Law& law, double friction, double dt, const DiskRows& rows,
                    const RowBatch& batch);
template <class Law>
void disk_forces(const Law& law, double friction, double dt, const DiskRows& rows,
                 const RowBatch& batch) {
  with_lanes([&](auto width) { disk_forces_of<width()>(law, friction, dt, rows, batch); });
}

}  // namespace grainfield::dem
