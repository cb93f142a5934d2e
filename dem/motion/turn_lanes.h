// The drift of turning bodies (verlet3.h) for several side by side: operation by operation what is
// done for one.
#pragma once
#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// By slot. Spin and rotation go a step on; the rotation is normalized.
struct alignas(64) TurnBatch {
  double spin[3][kBatch];      ///< rad/s
  double rotation[4][kBatch];  ///< x, y, z, w
  double torque[3][kBatch];    ///< N m
  double moments[3][kBatch];   ///< kg m2
};

/// Turns slots 0 to count - 1 for a step of dt, s. The bits do not depend on W.
template <int W>
void drift_turning_of(TurnBatch& b, double dt, int count);
inline void drift_turning(TurnBatch& b, double dt, int count) {
  with_lanes([&](auto width) { drift_turning_of<width()>(b, dt, count); });
}

}  // namespace grainfield::dem
