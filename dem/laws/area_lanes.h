// Forces of Roul's law on pairs of polygons side by side: motion at the contact, repulsion,
// dashpots and friction, operation by operation what is done for one (kinematics.h,
// area_dashpots.h, contact.h).
#pragma once
#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// Numbers of the law, as its scalar form has them.
struct AreaNumbers {
  double young = 0, damping = 0;
  double tangential = 0;        ///< k_t, N/m
  double friction = 0, dt = 0;  ///< dt > 0, s
};

/// By position in the batch of overlaps; those that do not touch come out with any numbers.
struct alignas(64) PlaneForceBatch {
  const double *body_i[kBatch], *body_j[kBatch];  ///< numbers of a Body<2>
  double spring[kBatch];                          ///< N; comes out advanced by the step
  double force[kBatch][4];                        ///< as ContactForce<2>
};

/// The bits do not depend on W.
template <int W>
void area_forces_of(const AreaNumbers& law, const PlaneOverlapBatch& overlaps,
                    PlaneForceBatch& forces);
inline void area_forces(const AreaNumbers& law, const PlaneOverlapBatch& overlaps,
                        PlaneForceBatch& forces) {
  with_lanes([&](auto width) { area_forces_of<width()>(law, overlaps, forces); });
}

}  // namespace grainfield::dem
