// Vectors, spins and rotations of two and of three dimensions under the same names, so that one
// text serves both. What only three dimensions need of Eigen is in space3.h.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <type_traits>

#include "dem/space/lanes3.h"

namespace grainfield::dem {

/// A vector whose layout is the same in every file, whatever Eigen's alignment there.
template <int D>
using PlainVector = Eigen::Matrix<double, D, 1, D == 2 ? Eigen::DontAlign : Eigen::AutoAlign>;

template <int D>
struct Space;

template <>
struct Space<2> {
  using Vector = PlainVector<2>;
  using Spin = double;        ///< about z: angular velocity, torque
  using Tangential = double;  ///< along (-n_y, n_x): slip, friction
  using Rotation = double;    ///< angle, rad
  using Moments = double;     ///< polar moment about the centroid

  /// How far apart two rotations are, rad.
  static double angle_between(double a, double b) { return std::fabs(a - b); }
};

/// The same of other numbers (number.h).
template <int D, class N>
struct SpaceOf {
  using Vector = Eigen::Matrix<N, D, 1, D == 2 ? Eigen::DontAlign : Eigen::AutoAlign>;
  using Spin = std::conditional_t<D == 2, N, Vector>;
  using Tangential = Spin;
};
template <int D, class N>
requires are_lanes<N>
struct SpaceOf<D, N> {
  using Vector = std::conditional_t<D == 2, Two<lanes_in<N>>, Three<lanes_in<N>>>;
  using Spin = std::conditional_t<D == 2, N, Vector>;
  using Tangential = Spin;
};
template <int D>
struct SpaceOf<D, double> : Space<D> {};

template <int D, class N = double>
using VectorOf = typename SpaceOf<D, N>::Vector;
template <int D, class N = double>
using SpinOf = typename SpaceOf<D, N>::Spin;
template <int D, class N = double>
using TangentialOf = typename SpaceOf<D, N>::Tangential;
template <int D>
using RotationOf = typename Space<D>::Rotation;

/// 0 of a number or of a vector.
template <class T>
T zero() {
  if constexpr (requires { T::Zero(); }) {
    return T::Zero();
  } else if constexpr (are_lanes<T>) {
    return T{};
  } else {
    return T(0);
  }
}

/// The rotation to start with.
template <class T>
T no_rotation() {
  if constexpr (std::is_arithmetic_v<T>) {
    return 0;
  } else {
    return T::Identity();
  }
}

/// Length of a vector, without overflow in the plane.
template <class Derived>
double length_of(const Eigen::MatrixBase<Derived>& v) {
  if constexpr (Derived::RowsAtCompileTime == 2) return std::hypot(v[0], v[1]);
  return v.norm();
}

/// The first D components of a vector in space.
template <int D>
VectorOf<D> in_space(const Eigen::Vector3d& v) {
  return v.template head<D>();
}
/// A vector with 0 for what the plane does not have.
inline Eigen::Vector3d to_three(const PlainVector<2>& v) { return {v[0], v[1], 0}; }
inline Eigen::Vector3d to_three(const Eigen::Vector3d& v) { return v; }

/// Size of a spin, a torque or a tangential force.
inline double size_of(double value) { return std::fabs(value); }
template <class Derived>
double size_of(const Eigen::MatrixBase<Derived>& value) {
  return value.norm();
}

/// A size with the sign that a number has.
inline double signed_size_of(double value) { return value; }
template <class Derived>
double signed_size_of(const Eigen::MatrixBase<Derived>& value) {
  return value.norm();
}

inline double square_of(double value) { return value * value; }
template <class Derived>
double square_of(const Eigen::MatrixBase<Derived>& value) {
  return value.squaredNorm();
}

}  // namespace grainfield::dem
