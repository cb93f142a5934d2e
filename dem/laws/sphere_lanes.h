// Pairs of spheres side by side, from the bodies to their sums of forces: overlap, motion, law,
// friction, operation by operation what is done for one (sphere_store.h, kinematics3.h, contact.h).
//
// Bodies, memories and sums are read and written where the engine has them, so that nothing is
// copied to a list first: W pairs are gathered by turning W rows of memory into columns.
#pragma once
#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

enum class SphereLawKind { hertz, linear, penalty };

/// Numbers of a law of spheres, as its scalar form has them.
struct SphereNumbers {
  SphereLawKind kind = SphereLawKind::hertz;
  double normal = 0, tangential = 0;  ///< stiffness; of Hertz' over the contact's radius
  /// Of dashpots: over the mass (linear), over mass and contact radius (viscoelastic), or
  /// 2 zeta.
  double across = 0, along = 0;
  bool displacement = false, viscoelastic = false;
  double friction = 0, dt = 0;  ///< dt > 0, s
};

/// Where the engine has what is read and written: rows of numbers of one size each. A body is a
/// Body<3>; a pair begins with the law's memory, of which HertzMemory<3> has four numbers and
/// SpringMemory<3> three (the next eight bytes are carried along unread); a sum is a ForceSum<3>.
struct SphereRows {
  const double* bodies = nullptr;
  int body_size = 0;  ///< numbers
  unsigned char* pairs = nullptr;
  int pair_size = 0, second = 0;  ///< bytes; where in a pair the second grain's index (int) is
  double* sums = nullptr;
  int sum_size = 0;  ///< numbers
  int ahead = 0;     ///< so many pairs on, what will be read is asked for
};

/// Pairs first, first + 1, ..., with the first grain of each.
struct SphereBatch {
  int count = 0, first = 0;
  int i[kBatch];
};

/// Their forces, added to the sums of both grains in the order of the pairs. The bits do not depend
/// on W. Behind the last pair there must be `ahead` idle ones.
template <int W>
void sphere_forces_of(const SphereNumbers& law, const SphereRows& rows, const SphereBatch& batch);
inline void sphere_forces(const SphereNumbers& law, const SphereRows& rows,
                          const SphereBatch& batch) {
  with_lanes([&](auto width) { sphere_forces_of<width()>(law, rows, batch); });
}

}  // namespace grainfield::dem
