// Force of one contact of spheres, or of a sphere at a plane, as a function of what the two have
// moved since the committed state: the engine's law without dashpots (laws/hertz.h, linear.h,
// rolling.h), with its increments over a step of time taken over the whole way.
//
//   slip       s = (u_i - u_j)_t + (theta_i l_i + theta_j l_j) x m      m: halfway from n0 to n
//   friction   T = cap(share S0' - k_t s', mu N)     ' : turned from n0 (m) to n
//   rolling    f = cap(f0' - k_r rho', mu_r N),      rho = R_eff (theta_i - theta_j) x m
//   twisting   t = cap(t0 - k_tw (theta_i - theta_j) . m, mu_tw N)
//   on i       F = -N n + T,  M = l_i n x T + R_eff n x f + t n
//   on j      -F,                 M = l_j n x T - (R_eff n x f + t n)
//
// S0 and f0 turn with the normal and by the mean rotation about it. k_t is that of the depth
// halfway where the law lets the spring grow with the contact's radius, `share` what the law leaves
// of S0. A contact that was open begins without springs and with the share of s since it closed,
// depth over approach.
//
// The text is one for numbers and for numbers with their derivatives by (u_i - u_j, theta_i,
// theta_j) (Eigen's AutoDiffScalar): the tangent is the exact derivative, with its branches.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <type_traits>
#include <unsupported/Eigen/AutoDiff>

#include "dem/laws/rolling.h"
#include "dem/quasistatic/sphere_law.h"

namespace grainfield::dem {

/// With its derivatives by the nine numbers of SphereMotion, in its order.
using Derived9 = Eigen::AutoDiffScalar<Eigen::Matrix<double, 9, 1>>;

/// What a contact remembers of the committed state.
struct SphereMemory {
  bool touched = false;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< from i to j
  double depth = 0, lever_i = 0, lever_j = 0;        ///< m
  Eigen::Vector3d spring = Eigen::Vector3d::Zero();  ///< of friction, on i, N
  Eigen::Vector3d roll = Eigen::Vector3d::Zero();    ///< pseudo-force of rolling, on i, N
  double twist = 0;                                  ///< moment about n, on i, N m
};

/// The two of them. A plane is j with radius 0.
struct SphereBodies {
  double radius_i = 0, radius_j = 0;                 ///< m
  Eigen::Vector3d across = Eigen::Vector3d::Zero();  ///< committed, from i to j or the plane's
                                                     ///< point, m
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();   ///< its normal, towards the grains
  double friction = 0;
  bool is_plane() const { return radius_j == 0; }
};

/// Since the committed state.
template <class T>
struct SphereMotion {
  Eigen::Matrix<T, 3, 1> shift;           ///< u_i - u_j, m
  Eigen::Matrix<T, 3, 1> turn_i, turn_j;  ///< rotation vectors, rad
};

template <class T>
struct SphereForce {
  using V = Eigen::Matrix<T, 3, 1>;
  T normal;              ///< N, repulsion, N
  V friction;            ///< T, N
  V force;               ///< on i, N
  V moment_i, moment_j;  ///< N m
  SphereMemory reached;  ///< values, for the next committed state
  bool slides = false;
};

namespace sphere_contact {

inline double value_of(double x) { return x; }
inline double value_of(const Derived9& x) { return x.value(); }

template <class T>
Eigen::Vector3d values_of(const Eigen::Matrix<T, 3, 1>& v) {
  return {value_of(v[0]), value_of(v[1]), value_of(v[2])};
}

/// f(x) where f and its slope are known at x's value.
template <class T>
T follow(const SphereLaw::Slope& f, const T& x) {
  if constexpr (std::is_same_v<T, double>) {
    return f.value;
  } else {
    return T(f.value, f.slope * x.derivatives());
  }
}

/// v, across `from`, turned the shortest way until it is across `to` (unit vectors).
template <class T>
Eigen::Matrix<T, 3, 1> carried(const Eigen::Matrix<T, 3, 1>& v, const Eigen::Matrix<T, 3, 1>& from,
                               const Eigen::Matrix<T, 3, 1>& to) {
  const T along = v.dot(to) / (T(1) + from.dot(to));
  return v - along * (from + to);
}

/// Shortened to `limit`; true in `cut` when it was longer, or where there is no room at all.
template <class T>
Eigen::Matrix<T, 3, 1> capped(const Eigen::Matrix<T, 3, 1>& v, const T& limit, bool& cut) {
  const T square = v.squaredNorm();
  cut = value_of(square) >= value_of(limit) * value_of(limit);
  if (!cut) return v;
  if (!(value_of(square) > 0)) return Eigen::Matrix<T, 3, 1>::Constant(T(0));
  using std::sqrt;
  const T share = limit / sqrt(square);
  return share * v;
}

}  // namespace sphere_contact

/// False: they do not touch.
template <class T>
bool sphere_force(const SphereLaw& law, const RollingLaw& rolling, const SphereBodies& b,
                  const SphereMemory& memory, const SphereMotion<T>& m, SphereForce<T>& out) {
  using namespace sphere_contact;
  using V = Eigen::Matrix<T, 3, 1>;
  using std::sqrt;
  const V across = b.across.template cast<T>() - m.shift;
  V n;
  T depth, lever_i, lever_j = T(0);
  double radius = b.radius_i;  // relative, of curvature
  if (b.is_plane()) {
    const V normal = b.plane.template cast<T>();
    lever_i = -across.dot(normal);
    depth = T(b.radius_i) - lever_i;
    if (!(value_of(depth) > 0)) return false;
    n = -normal;
  } else {
    const double reach = b.radius_i + b.radius_j;
    const T distance = sqrt(across.squaredNorm());
    depth = T(reach) - distance;
    if (!(value_of(depth) > 0) || !(value_of(distance) > 0)) return false;
    n = across / distance;
    lever_i = T(b.radius_i) - depth * (T(2 * b.radius_j) - depth) / (T(2) * distance);
    lever_j = distance - lever_i;
    radius = b.radius_i * b.radius_j / reach;
  }
  out.normal = follow(law.repulsion(value_of(depth), radius), depth);

  // What was: of a contact that was open, what is.
  const V before = memory.touched ? V(memory.normal.template cast<T>()) : n;
  const V halfway = V(before + n) / sqrt((before + n).squaredNorm());
  T mean_i = lever_i, mean_j = lever_j, share = T(1), closed = T(1);
  T stiffness;
  if (memory.touched) {
    mean_i = T(0.5) * (lever_i + T(memory.lever_i));
    mean_j = T(0.5) * (lever_j + T(memory.lever_j));
    share = follow(law.kept(memory.depth, value_of(depth), radius), depth);
    const double at = law.depth_of_stiffness(memory.depth, value_of(depth));
    const double weight = at == value_of(depth) ? 1.0 : 0.5;
    stiffness = follow(law.spring(at, radius).scaled(weight), depth);
  } else {
    const T approach = m.shift.dot(n);
    if (value_of(approach) > value_of(depth)) closed = depth / approach;
    stiffness = follow(law.spring(0.5 * value_of(depth), radius).scaled(0.5), depth);
  }

  const V levered = mean_i * m.turn_i + mean_j * m.turn_j;
  V slip = m.shift - m.shift.dot(halfway) * halfway + V(levered.cross(halfway));
  slip = closed * carried(slip, halfway, n);
  const T spin = T(0.5) * (m.turn_i + m.turn_j).dot(n);
  const auto turned = [&](const Eigen::Vector3d& old) {
    if (old.isZero(0)) return V(V::Constant(T(0)));
    const V v = carried(V(old.template cast<T>()), before, n);
    return V(v + spin * V(n.cross(v)) - T(0.5) * spin * spin * v);
  };
  out.friction = capped(V(share * turned(memory.spring) - stiffness * slip),
                        T(T(b.friction) * out.normal), out.slides);

  V couple = V::Constant(T(0)), roll = couple;
  T twist = T(0);
  if (rolling.on()) {
    bool cut = false;
    const double arm = b.is_plane() ? b.radius_i : radius;
    const V turning = m.turn_i - m.turn_j;
    if (rolling.stiffness > 0) {
      const V way = closed * carried(V(arm * V(turning.cross(halfway))), halfway, n);
      roll = capped(V(turned(memory.roll) - rolling.stiffness * way),
                    T(T(rolling.friction) * out.normal), cut);
      couple = arm * V(n.cross(roll));
    }
    if (rolling.twisting_stiffness > 0) {
      twist = T(memory.twist) - rolling.twisting_stiffness * closed * turning.dot(halfway);
      const T limit = T(rolling.twisting_friction) * out.normal;
      if (std::fabs(value_of(twist)) >= value_of(limit)) {
        twist = value_of(twist) < 0 ? T(-limit) : limit;
      }
      couple += twist * n;
    }
  }

  out.force = out.friction - out.normal * n;
  const V turning = n.cross(out.friction);
  out.moment_i = lever_i * turning + couple;
  out.moment_j = lever_j * turning - couple;
  out.reached = {true,
                 values_of(n),
                 value_of(depth),
                 value_of(lever_i),
                 value_of(lever_j),
                 values_of(out.friction),
                 values_of(roll),
                 value_of(twist)};
  return true;
}

}  // namespace grainfield::dem
