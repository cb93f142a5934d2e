// What the contact loop reads of a grain (in two dimensions one cache line), and what it writes.
#pragma once
#include "dem/space/space.h"

namespace grainfield::dem {

/// Kinematics and inertia of one grain. A fixed grain has inverse mass and inertia 0.
template <int D>
struct alignas(D == 2 ? 64 : 32) Body {
  VectorOf<D> position = zero<VectorOf<D>>();  ///< centroid, m
  VectorOf<D> velocity = zero<VectorOf<D>>();  ///< m/s
  SpinOf<D> spin = zero<SpinOf<D>>();          ///< rad/s
  double radius = 0;                           ///< m
  double inverse_mass = 0;                     ///< 1/kg
  double inverse_inertia = 0;  ///< 1/(kg m2); in 3D of the mean moment: dashpots go by it
};
static_assert(sizeof(Body<2>) == 64);

/// Mass and moments of a grain, of fixed ones too.
template <int D>
struct Inertia {
  double mass = 0;                                                          ///< kg
  typename Space<D>::Moments moments = zero<typename Space<D>::Moments>();  ///< kg m2
  double volume = 0;                                                        ///< m3; m2 in 2D
};

/// Force and torques of one contact, written by the contact loop, gathered per grain.
template <int D>
struct ContactForce {
  VectorOf<D> force = zero<VectorOf<D>>();  ///< on the first grain, N
  SpinOf<D> torque_i = zero<SpinOf<D>>();   ///< about the centroids, N m
  SpinOf<D> torque_j = zero<SpinOf<D>>();
};

/// Sum of forces on one grain.
template <int D>
struct alignas(D == 2 ? 32 : 64) ForceSum {
  VectorOf<D> force = zero<VectorOf<D>>();
  SpinOf<D> torque = zero<SpinOf<D>>();
  double force_sum = 0;  ///< sum of the forces' lengths; where sleeping is judged

  /// Adds to a contact's second grain without turning the force round: what a sleeper feels.
  void add_second(const ContactForce<D>& f) {
    force += f.force;
    torque += f.torque_j;
    force_sum += f.force.norm();
  }
  /// What a grain passes on when all forces on it, its weight too, are in the sum, N: a column of
  /// grains carries its weight above each of them and the grain's own.
  double load() const { return 0.5 * force_sum; }
};

}  // namespace grainfield::dem
