// A model in space seen through the averaging: smooth.h in three dimensions.
#pragma once
#include <Eigen/Core>

#include "coupling/averaging/kernel.h"
#include "coupling/compare/smooth.h"

namespace grainfield::coupling {

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
