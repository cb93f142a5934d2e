// Pairs of spheres side by side, from the bodies to their sums of forces: overlap, motion, law,
// friction, resistance against rolling by the text that one pair has (round_overlap.h,
// kinematics3.h, the law's own, rolling.h).
//
// Bodies, memories and sums are read and written where the engine has them, so that nothing is
// copied to a list first: W pairs are gathered by turning W rows of memory into columns.
#pragma once
#include "dem/laws/rolling.h"
#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// What the kernel expects of the engine's rows. Numbers of a Body<3>, of a ForceSum<3>, whose last
/// two it may add 0 to, and of a ContactForce<3>, which begins as a sum does. What will be read is
/// asked for so many pairs ahead.
inline constexpr int kSphereBody = 12, kSphereSum = 8, kSphereForce = 9, kPairsAhead = 16;
/// Bytes of a pair, of which the first are the law's memory; eight bytes more are read.
template <class Law>
inline constexpr int kSpherePair = sizeof(typename Law::template Memory<3>) + 8;

/// Where the engine has what is read and written.
struct SphereRows {
  const double* bodies = nullptr;
  unsigned char* pairs = nullptr;
  double* sums = nullptr;
  double* rolling = nullptr;  ///< by pair, RollingMemory<3>: four numbers; null: no resistance
  double* kept = nullptr;     ///< by pair, ContactForce<3> that are 0: these, not the sums
};

/// Their forces in a step of dt > 0, s, added to the sums of both grains in the order of the pairs.
/// The bits do not depend on W.
template <int W, class Law>
void sphere_forces_of(const Law& law, double friction, double dt, const RollingLaw& rolling,
                      const SphereRows& rows, const RowBatch& batch);
template <class Law>
void sphere_forces(const Law& law, double friction, double dt, const RollingLaw& rolling,
                   const SphereRows& rows, const RowBatch& batch) {
  with_lanes(
      [&](auto width) { sphere_forces_of<width()>(law, friction, dt, rolling, rows, batch); });
}

}  // namespace grainfield::dem
