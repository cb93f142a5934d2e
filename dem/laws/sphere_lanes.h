// Pairs of spheres side by side, from the bodies to their sums of forces: overlap, motion, law,
// friction, resistance against rolling, operation by operation what is done for one
// (sphere_store.h, kinematics3.h, contact.h, rolling.h).
//
// Bodies, memories and sums are read and written where the engine has them, so that nothing is
// copied to a list first: W pairs are gathered by turning W rows of memory into columns.
#pragma once
#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

enum class SphereLawKind { hertz, linear, penalty };

/// Numbers of a law of spheres, as its scalar form has them.
struct RoundNumbers {
  SphereLawKind kind = SphereLawKind::hertz;
  double normal = 0, tangential = 0;  ///< stiffness; of Hertz' over the contact's radius
  /// Rates of dashpots: over the mass (linear), over mass and contact radius (viscoelastic), or
  /// 2 zeta.
  double across = 0, along = 0;
  bool displacement = false, viscoelastic = false;
  double friction = 0, dt = 0;  ///< dt > 0, s
};

/// Resistance against rolling and twisting, as RollingLaw (rolling.h) has it.
struct RollingNumbers {
  double stiffness = 0, damping = 0, friction = 0;
  double twisting_stiffness = 0, twisting_damping = 0, twisting_friction = 0;
};

/// What the kernel expects of the engine's rows. Numbers of a Body<3>, of a ForceSum<3>, whose last
/// two it may add 0 to, and of a ContactForce<3>, which begins as a sum does; bytes of a pair, of
/// which the first are the law's memory (HertzMemory<3> four numbers, SpringMemory<3> three; eight
/// bytes more are read). What will be read is asked for so many pairs ahead.
inline constexpr int kSphereBody = 12, kSphereSum = 8, kSphereForce = 9, kPairsAhead = 16;
constexpr int pair_size(SphereLawKind kind) { return kind == SphereLawKind::hertz ? 40 : 32; }

/// Where the engine has what is read and written.
struct SphereRows {
  const double* bodies = nullptr;
  unsigned char* pairs = nullptr;
  double* sums = nullptr;
  double* rolling = nullptr;  ///< by pair, RollingMemory<3>: four numbers; null: no resistance
  double* kept = nullptr;     ///< by pair, ContactForce<3> that are 0: these, not the sums
};

/// Their forces, added to the sums of both grains in the order of the pairs. The bits do not depend
/// on W.
template <int W>
void sphere_forces_of(const RoundNumbers& law, const RollingNumbers& rolling,
                      const SphereRows& rows, const RowBatch& batch);
inline void sphere_forces(const RoundNumbers& law, const RollingNumbers& rolling,
                          const SphereRows& rows, const RowBatch& batch) {
  with_lanes([&](auto width) { sphere_forces_of<width()>(law, rolling, rows, batch); });
}

}  // namespace grainfield::dem
