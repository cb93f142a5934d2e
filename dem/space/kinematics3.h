// The same as kinematics.h in three dimensions, with vectors from the centroids to the contact.
#pragma once
#include "dem/space/kinematics.h"
#include "dem/space/space3.h"

namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS {

template <bool central, class N>
[[gnu::always_inline]] inline ContactMotion<3, N> motion_at(const Body<3, N>& a,
                                                            const Body<3, N>& b,
                                                            const Overlap3Of<N>& o) {
  const VectorOf<3, N> v = a.velocity - b.velocity + a.spin.cross(o.arm_i) - b.spin.cross(o.arm_j);
  ContactMotion<3, N> m;
  m.approach = v.dot(o.normal);
  m.slip = v - m.approach * o.normal;
  set_inertia(a, b, m);
  return m;
}

/// Of a force, or of that part of it which is not along the arms.
template <class N>
[[gnu::always_inline]] inline void set_torques(const Overlap3Of<N>& o,
                                               const VectorOf<3, N>& turning,
                                               ContactForce<3, N>& f) {
  f.torque_i = o.arm_i.cross(turning);
  f.torque_j = -o.arm_j.cross(turning);
}
template <bool central, class N>
[[gnu::always_inline]] inline ContactForce<3, N> forces_at(const Overlap3Of<N>& o,
                                                           const std::type_identity_t<N>& normal,
                                                           const VectorOf<3, N>& tangential) {
  ContactForce<3, N> f;
  f.force = tangential - normal * o.normal;
  // Where the arms lie along the normal, the repulsion has none.
  set_torques<N>(o, central ? tangential : f.force, f);
  return f;
}

template <bool central>
inline Eigen::Vector3d point_at(const Body<3>& a, const Overlap3& o) {
  return a.position + o.arm_i;
}

inline Eigen::Vector3d normal_of(const Overlap3& o) { return o.normal; }
template <class N>
[[gnu::always_inline]] inline N repulsion_of(const VectorOf<3, N>& force, const Overlap3Of<N>& o) {
  return -force.dot(o.normal);
}
inline Eigen::Vector3d tangential_of(const Eigen::Vector3d& force, const Overlap3& o) {
  return force + repulsion_of(force, o) * o.normal;
}

/// A spring (N, across the former normal) turns with the contact: into the plane across `normal`,
/// its size kept, and by `twist` (rad) about it.
template <class N>
[[gnu::always_inline]] inline void turn_with_contact(VectorOf<3, N>& spring,
                                                     const VectorOf<3, N>& normal, const N& twist,
                                                     const Overlap3Of<N>& /*o*/) {
  using V = VectorOf<3, N>;
  const N before = spring.squaredNorm();
  if constexpr (!are_lanes<N>) {
    if (!(before > 0)) return;
  }
  V turned = spring - spring.dot(normal) * normal;
  turned = turned + twist * normal.cross(turned);
  const N now = turned.squaredNorm();
  turned = chosen(now > 0, V(root(N(before / now)) * turned), turned);
  spring = chosen(before > 0, turned, spring);
}
/// How far both bodies turn about the normal in dt, s, in the mean: rad.
template <class N>
[[gnu::always_inline]] inline N twist_of(const Body<3, N>& a, const Body<3, N>& b,
                                         const Overlap3Of<N>& o, double dt) {
  return 0.5 * dt * (a.spin + b.spin).dot(o.normal);
}

/// v turned by `turn` (rad, its direction the axis).
inline Eigen::Vector3d turned_by(const Eigen::Vector3d& turn, const Eigen::Vector3d& v) {
  // Rodrigues: with t along the axis, |t| = tan(angle/2), v + 2/(1 + t^2) (t x v + t x (t x v)).
  const double square = turn.squaredNorm();
  double share =
      0.5 * (1 + square * (1.0 / 12 + square * (1.0 / 120 + square * (17.0 / 20160 +
                                                                      square * (31.0 / 362880)))));
  if (!(square < 1e-2)) {  // beyond it the series' next term counts
    const double angle = std::sqrt(square);
    const Rotation half = rotation_of(0.5 * angle);
    share = half.sine / (half.cosine * angle);
  }
  const Eigen::Vector3d t = share * turn, once = t.cross(v);
  return v + 2 / (1 + t.squaredNorm()) * (once + t.cross(once));
}

/// The same where the points in contact do not lie on the line of centres: the spring turns with
/// the material, by the mean turn of both bodies (rad), exactly, then into the plane across
/// `normal`.
inline void turn_with_material(Eigen::Vector3d& spring, const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& turn) {
  const double size = spring.norm();
  if (!(size > 0)) return;
  spring = turned_by(turn, spring);
  spring -= spring.dot(normal) * normal;
  const double now = spring.norm();
  if (now > 0) spring *= size / now;
}

}  // namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS
