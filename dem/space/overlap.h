// What two shapes in contact say of their overlap, and laws read.
#pragma once
#include <Eigen/Core>
#include <type_traits>

#include "dem/space/space3.h"

namespace grainfield::dem {

/// What a law reads of an overlap beside its normal, depth and contact point.
enum class Measures {
  depth,     ///< nothing else
  area,      ///< area, chord, and the length l that follows the contact point
  gradient,  ///< area, chord, normal and contact point that are exactly the area's derivatives, and
             ///< a length that stays: l0 = R_i R_j/(R_i + R_j), R of the circle of equal area (at a
             ///< wall R_i)
  curvature,   ///< relative radius of curvature
  curvatures,  ///< both relative principal curvatures and their directions
};

inline namespace GRAINFIELD_INSTRUCTIONS {

/// Geometry of one contact in the plane. With the tangent t = (-ny, nx) and the contact point s:
/// s - x_i = lever_i n + shift_i t, s - x_j = -lever_j n + shift_j t.
template <class N>
struct Overlap2Of {
  N nx = zero<N>(), ny = zero<N>();            ///< unit normal from the first towards the second
  N depth = zero<N>();                         ///< penetration along the normal, m
  N area = zero<N>();                          ///< overlap area, m2 (only when asked for)
  N chord = zero<N>();                         ///< length of the contact line, m (likewise)
  N arm_i = zero<N>(), arm_j = zero<N>();      ///< of the contact point from the centroids, m
  N length = zero<N>();                        ///< characteristic length l, m (likewise)
  N lever_i = zero<N>(), lever_j = zero<N>();  ///< polygons only; of disks lever = arm
  N shift_i = zero<N>(), shift_j = zero<N>();  ///< polygons only; of disks 0
};
using Overlap = Overlap2Of<double>;

/// Geometry of one contact in space.
template <class N>
struct Overlap3Of {
  using Vector = VectorOf<3, N>;
  Vector normal = Vector::Zero();  ///< unit, from the first towards the second
  N depth = zero<N>();             ///< penetration along the normal, m
  Vector arm_i = Vector::Zero();   ///< from the centroids to the contact point, m
  Vector arm_j = Vector::Zero();
  /// Relative radius of curvature: R_i R_j/(R_i + R_j) of spheres, m. With curvatures that of the
  /// spheres of equal volume, which the curvatures are measured by.
  N radius = zero<N>();
  N lesser_curvature = zero<N>();   ///< A, 1/m: 1/(2 radius) of spheres (only when asked for)
  N greater_curvature = zero<N>();  ///< B, 1/m
  Vector major = Vector::UnitX();   ///< unit: the direction of A
};
using Overlap3 = Overlap3Of<double>;

template <int D, class N = double>
using OverlapIn = std::conditional_t<D == 2, Overlap2Of<N>, Overlap3Of<N>>;

}  // namespace GRAINFIELD_INSTRUCTIONS
}  // namespace grainfield::dem
