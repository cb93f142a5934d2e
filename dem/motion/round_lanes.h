// The end of a step and the beginning of the next for spheres side by side, velocity Verlet:
// operation by operation what is done for one (verlet3.h, motion/load.h, contacts/margins.h).
// The acceleration and torque of the step that has ended are not kept: the next step that ends
// makes them anew.
#pragma once
#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// Numbers of a Body<3>, a memory of VerletIntegrator<3>, a ForceSum<3> and an Inertia<3>.
inline constexpr int kRoundBody = 12, kRoundMemory = 10, kRoundSum = 8, kRoundInertia = 5;

/// Where a body was at the last search, and how far it may go from there, m (Margin<3>).
struct alignas(32) RoundMargin {
  double position[3] = {}, way = 0;
};

/// Where the engine has what is read and written. The sums are 0 then; all moments of an inertia
/// are equal.
struct RoundRows {
  double *bodies = nullptr, *memories = nullptr, *sums = nullptr;
  const double* inertias = nullptr;
  const RoundMargin* margins = nullptr;
};

struct RoundStep {
  double dt = 0;           ///< s
  double gravity[3] = {};  ///< m/s2
  double drag = 0;         ///< 1/s
  double local_damping = 0;
};

/// Moves grains list[0] to list[count - 1], ascending, of inverse moment above 0. True when one
/// may have left its margin. The bits do not depend on W.
template <int W>
bool round_steps_of(const RoundStep& step, const RoundRows& rows, const int* list, int count);
inline bool round_steps(const RoundStep& step, const RoundRows& rows, const int* list, int count) {
  bool moved = false;
  with_lanes([&](auto width) { moved = round_steps_of<width()>(step, rows, list, count); });
  return moved;
}

}  // namespace grainfield::dem
