// What the contact loop reads of a grain: one cache line.
#pragma once

namespace grainfield::dem {

/// Kinematics and inertia of one grain. A fixed grain has inverse mass and inertia 0.
struct alignas(64) Body {
  double x = 0, y = 0;         ///< centroid, m
  double vx = 0, vy = 0;       ///< m/s
  double spin = 0;             ///< rad/s
  double radius = 0;           ///< m
  double inverse_mass = 0;     ///< 1/kg
  double inverse_inertia = 0;  ///< 1/(kg m2)
};
static_assert(sizeof(Body) == 64);

/// Force and torques of one contact, written by the contact loop, gathered per grain.
struct ContactForce {
  double fx = 0, fy = 0;              ///< on the first grain, N
  double torque_i = 0, torque_j = 0;  ///< about the centroids, N m
};

}  // namespace grainfield::dem
