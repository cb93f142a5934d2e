// What the contact loop reads of a grain (in two dimensions one cache line), and what it writes.
#pragma once
#include "dem/space/space.h"

namespace grainfield::dem {

/// Kinematics and inertia of one grain. A fixed grain has inverse mass and inertia 0.
template <int D, class N = double>
struct alignas(D == 2 ? 64 : 32) alignas(N) Body {
  VectorOf<D, N> position = zero<VectorOf<D, N>>();  ///< centroid, m
  VectorOf<D, N> velocity = zero<VectorOf<D, N>>();  ///< m/s
  SpinOf<D, N> spin = zero<SpinOf<D, N>>();          ///< rad/s
  N radius = zero<N>();                              ///< m
  N inverse_mass = zero<N>();                        ///< 1/kg
  N inverse_inertia = zero<N>();  ///< 1/(kg m2); in 3D of the mean moment: dashpots go by it
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
template <int D, class N = double>
struct ContactForce {
  VectorOf<D, N> force = zero<VectorOf<D, N>>();  ///< on the first grain, N
  SpinOf<D, N> torque_i = zero<SpinOf<D, N>>();   ///< about the centroids, N m
  SpinOf<D, N> torque_j = zero<SpinOf<D, N>>();
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
