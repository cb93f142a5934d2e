// Mean strain of a cluster of grains from the convex hull of their centres (Wellmann eq. 30), and
// from least squares over the same grains.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace grainfield::coupling {

/// A closed surface of triangles: rows of the points, counter-clockwise as seen from outside.
using Hull = std::vector<std::array<int, 3>>;

/// Convex hull of n x 3 points, m (Qhull; faces of more corners are cut into triangles). Throws
/// std::invalid_argument for fewer than four points, and for such as lie in a plane.
Hull convex_hull(const Eigen::MatrixXd& points);

/// m3, of the surface at these points, which may be others than those it was made of.
double hull_volume(const Hull& hull, const Eigen::MatrixXd& points);

/// Mean displacement gradient du_i/dx_j within the surface (row i, column j),
///   (1/V) sum over triangles of (mean u of the corners) (outer) n A,
/// whose symmetric part is Wellmann's eq. 30. n x 3, m: points and displacements. Exact where u is
/// affine in x.
Eigen::Matrix3d hull_gradient(const Hull& hull, const Eigen::MatrixXd& points,
                              const Eigen::MatrixXd& displacements);

/// The gradient of the affine displacement nearest to those of all the points (least squares).
/// Throws std::invalid_argument for such as lie in a plane.
Eigen::Matrix3d fitted_gradient(const Eigen::MatrixXd& points,
                                const Eigen::MatrixXd& displacements);

}  // namespace grainfield::coupling
