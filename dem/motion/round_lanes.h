// The end of a step and the beginning of the next for spheres side by side, velocity Verlet:
// operation by operation what is done for one (verlet3.h, motion/load.h, contacts/margins.h).
#pragma once
#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// Where the engine has what is read and written (laws/sphere_lanes.h): bodies Body<3>; memories of
/// VerletIntegrator<3>; sums ForceSum<3>, which are 0 then; inertias Inertia<3>, all of whose
/// moments are equal; margins Margin<3>. Sizes count numbers.
struct RoundRows {
  double *bodies = nullptr, *memories = nullptr, *sums = nullptr;
  const double *inertias = nullptr, *margins = nullptr;
  int body_size = 0, memory_size = 0, sum_size = 0, inertia_size = 0, margin_size = 0;
  int way = 0;  ///< where in a margin the way is
};

struct RoundStep {
  double dt = 0;           ///< s
  double gravity[3] = {};  ///< m/s2
  double drag = 0;         ///< 1/s
};

/// Of grains list[0] to list[count - 1], whose inverse moment is above 0. True when one may have
/// left its margin. The bits do not depend on W.
template <int W>
bool round_steps_of(const RoundStep& step, const RoundRows& rows, const int* list, int count);
inline bool round_steps(const RoundStep& step, const RoundRows& rows, const int* list, int count) {
  bool moved = false;
  with_lanes([&](auto width) { moved = round_steps_of<width()>(step, rows, list, count); });
  return moved;
}

}  // namespace grainfield::dem
