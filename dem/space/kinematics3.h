// The same as kinematics.h in three dimensions, with vectors from the centroids to the contact.
#pragma once
#include "dem/space/kinematics.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

template <bool central>
inline ContactMotion<3> motion_at(const Body<3>& a, const Body<3>& b, const Overlap3& o) {
  const Eigen::Vector3d v = a.velocity - b.velocity + a.spin.cross(o.arm_i) - b.spin.cross(o.arm_j);
  ContactMotion<3> m;
  m.approach = v.dot(o.normal);
  m.slip = v - m.approach * o.normal;
  set_inertia(a, b, m);
  return m;
}

template <bool central>
inline ContactForce<3> forces_at(const Overlap3& o, double normal,
                                 const Eigen::Vector3d& tangential) {
  ContactForce<3> f;
  f.force = tangential - normal * o.normal;
  // Where the arms lie along the normal, the repulsion has none.
  const Eigen::Vector3d turning = central ? tangential : f.force;
  f.torque_i = o.arm_i.cross(turning);
  f.torque_j = -o.arm_j.cross(turning);
  return f;
}

template <bool central>
inline Eigen::Vector3d point_at(const Body<3>& a, const Overlap3& o) {
  return a.position + o.arm_i;
}

inline Eigen::Vector3d normal_of(const Overlap3& o) { return o.normal; }
inline double repulsion_of(const Eigen::Vector3d& force, const Overlap3& o) {
  return -force.dot(o.normal);
}
inline Eigen::Vector3d tangential_of(const Eigen::Vector3d& force, const Overlap3& o) {
  return force + repulsion_of(force, o) * o.normal;
}

/// A spring (N, across the former normal) turns with the contact: into the plane across `normal`,
/// its size kept, and by `twist` (rad) about it.
inline void turn_with_contact(Eigen::Vector3d& spring, const Eigen::Vector3d& normal, double twist,
                              const Overlap3& /*o*/) {
  const double size = spring.norm();
  if (!(size > 0)) return;
  spring -= spring.dot(normal) * normal;
  spring += twist * normal.cross(spring);
  const double now = spring.norm();
  if (now > 0) spring *= size / now;
}

}  // namespace grainfield::dem
