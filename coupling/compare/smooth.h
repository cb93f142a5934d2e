// A model seen through the averaging: its stress convolved with the kernel that made the data, so
// that the kernel's broadening of a peak is not counted against the model.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>

#include "coupling/averaging/kernel.h"

namespace grainfield::coupling {

/// n x 2 points in the models' frame to n x 3 stresses (xx, yy, xy), nan outside.
using StressFunction = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;

/// A smoothing is linear: where it asks for the stress, and by how much every value counts.
struct SmoothingNodes {
  Eigen::MatrixXd at;                                   ///< nodes x dimension
  Eigen::SparseMatrix<double, Eigen::RowMajor> weight;  ///< points x nodes

  /// The smoothed stress, one row per point. One call of `stress`.
  Eigen::MatrixXd of(const StressFunction& stress) const { return weight * stress(at); }
};

/// Convolution over the plane at the points (models' frame, inside is -depth < y < 0). Nodes below
/// the base take the value at the base above (what extend_into_walls does to the data), nodes above
/// the surface count zero stress (as empty space does). `rings` radial Gauss points times 2 rings +
/// 2 directions; within 1.5 kernel ranges of the load (0, 0) 4 rings squared points in polar
/// coordinates about it. depth <= 0: a half plane.
SmoothingNodes nodes_in_plane(const Eigen::MatrixXd& points, const Kernel& kernel, double depth,
                              int rings = 6);

/// Convolution along x with the kernel's marginal: what base_profile does to floor forces.
SmoothingNodes nodes_along_x(const Eigen::MatrixXd& points, const Kernel& kernel, int count = 15);

/// Convolution over space at the points (n x 3, models' frame: load at the origin, inside is
/// -depth < z < 0). Below the base and above the surface as nodes_in_plane. `rings` Gauss
/// points along the radius and over the height of the sphere, 2 rings round it; within 1.5 kernel
/// ranges of the load, where the stress grows as 1/distance^2, 3 rings of each in spherical
/// coordinates about it. depth <= 0: a half space. Throws
/// std::invalid_argument for points or a kernel of the plane.
SmoothingNodes nodes_in_space(const Eigen::MatrixXd& points, const Kernel& kernel, double depth,
                              int rings = 6);

/// Convolution over the horizontal plane at the points with the kernel as it is seen from above:
/// what base_stress does to floor forces. `rings` Gauss points along the radius times
/// 2 rings + 2 directions. Throws as nodes_in_space.
SmoothingNodes nodes_over_plane(const Eigen::MatrixXd& points, const Kernel& kernel, int rings = 8);

}  // namespace grainfield::coupling
