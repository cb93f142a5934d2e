// Trace, deviator and principal axes of symmetric tensors, and the angles between them.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/base/field.h"

namespace grainfield::coupling {

/// Principal values and axes. In 2D the third row and column are left out.
struct TensorAxes {
  int dim = 2;
  Eigen::Vector3d values{0, 0, 0};                     ///< from the largest to the smallest
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< column k: unit axis of values[k]

  double trace() const;
  /// 2D: largest - smallest (Roul 3.7: F_max - F_min). 3D: sqrt(3/2 s:s), s the deviatoric part,
  /// which is largest - smallest when the two others are equal.
  double deviator() const;
  /// deviator / trace; nan where the trace is 0. Roul 3.7: F_D / tr F.
  double deviatoric_fraction() const;
  /// 2D: of axis k from the x axis, degrees in (-90, 90]; nan where the values coincide (deviator
  /// at most 1e-12 of the largest value) and in 3D.
  double angle_deg(int k = 0) const;
};

/// Axes of the symmetric part of the tensor. nan in it: nan everywhere.
TensorAxes tensor_axes(const Eigen::Matrix3d& tensor, int dim);
TensorAxes tensor_axes(double xx, double yy, double xy);

/// Angle between two axes (not directions) given in degrees: in [0, 90].
double angle_between_axes_deg(double a, double b);

/// Which axis of a tensor is its major one: of a stress or strain (tension positive) the one of the
/// greatest compression, so that it points along the force chains; of fabric and inertia the one of
/// the largest value.
enum class MajorAxis { largest, most_compressive };

/// Adds to a 2D field, from its columns NAME_xx, NAME_yy, NAME_xy (of a stress with NAME_yx their
/// mean): NAME_trace, NAME_deviator (unit of NAME_xx), NAME_fraction (1; deviator over trace,
/// negative for a compressive stress), NAME_angle (deg). Throws std::invalid_argument naming the
/// missing column.
void add_tensor_columns(Field& field, const std::string& name, MajorAxis major);
/// Adds angle_A_B (deg, 0 to 90) from the columns A_angle and B_angle. Throws as above.
void add_angle_between(Field& field, const std::string& a, const std::string& b);

}  // namespace grainfield::coupling
