// Pairs of disks side by side, from the bodies to their sums of forces, with the linear law:
// overlap, motion, law and friction, operation by operation what is done for one (shapes/disk.h,
// kinematics.h, linear.h, contact.h).
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

/// Their forces, added to the sums of both grains in the order of the pairs. The bits do not depend
/// on W.
template <int W>
void disk_forces_of(const RoundNumbers& law, const DiskRows& rows, const RowBatch& batch);
inline void disk_forces(const RoundNumbers& law, const DiskRows& rows, const RowBatch& batch) {
  with_lanes([&](auto width) { disk_forces_of<width()>(law, rows, batch); });
}

}  // namespace grainfield::dem
