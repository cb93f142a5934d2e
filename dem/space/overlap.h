// What two shapes in contact say of their overlap, and laws read.
#pragma once
#include <Eigen/Core>
#include <type_traits>

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

/// Geometry of one contact in the plane. With the tangent t = (-ny, nx) and the contact point s:
/// s - x_i = lever_i n + shift_i t, s - x_j = -lever_j n + shift_j t.
struct Overlap {
  double nx = 0, ny = 0;            ///< unit normal from the first towards the second
  double depth = 0;                 ///< penetration along the normal, m
  double area = 0;                  ///< overlap area, m2 (only when asked for)
  double chord = 0;                 ///< length of the contact line, m (only when asked for)
  double arm_i = 0, arm_j = 0;      ///< distance of the contact point from the centroids, m
  double length = 0;                ///< characteristic length l, m (only when asked for)
  double lever_i = 0, lever_j = 0;  ///< polygons only; of disks lever = arm
  double shift_i = 0, shift_j = 0;  ///< polygons only; of disks 0
};

/// Geometry of one contact in space.
struct Overlap3 {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, from the first towards the second
  double depth = 0;                                  ///< penetration along the normal, m
  Eigen::Vector3d arm_i = Eigen::Vector3d::Zero();   ///< from the centroids to the contact point, m
  Eigen::Vector3d arm_j = Eigen::Vector3d::Zero();
  /// Relative radius of curvature: R_i R_j/(R_i + R_j) of spheres, m. With curvatures that of the
  /// spheres of equal volume, which the curvatures are measured by.
  double radius = 0;
  double lesser_curvature = 0;   ///< A, 1/m: 1/(2 radius) of spheres (only when asked for)
  double greater_curvature = 0;  ///< B, 1/m
  Eigen::Vector3d major = Eigen::Vector3d::UnitX();  ///< unit: the direction of A
};

template <int D>
using OverlapIn = std::conditional_t<D == 2, Overlap, Overlap3>;

}  // namespace grainfield::dem
