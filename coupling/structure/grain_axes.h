// How grains lie: principal axes of their own inertia tensors (Roul 2.92, 3.5).
#pragma once
#include <Eigen/Core>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Axes of the free grains of a 2D snapshot, in its order.
struct GrainAxes {
  Eigen::VectorXd inertia_angle_deg;  ///< major axis of the inertia tensor (theta_xx = integral of
                                      ///< y y), from x, (-90, 90]; nan where there is none (disks)
  Eigen::VectorXd long_angle_deg;     ///< the axis across: along the grain's length
  Eigen::VectorXd elongation;         ///< sqrt(largest / smallest inertia): 1 of a disk, a/b of an
                                      ///< ellipse
  /// Nematic order of the long axes: |mean of exp(2 i angle)|, 0 without any order, 1 all parallel;
  /// nan when no grain has an axis. For n random axes about sqrt(pi / (4 n)).
  double order = 0;
  double director_deg = 0;  ///< mean long axis, half the argument of that mean; nan with order
};

/// Throws std::invalid_argument for a 3D snapshot.
GrainAxes grain_axes(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
