// Where to average: grids, lines and horizontal cuts.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace grainfield::coupling {

/// n equally spaced points from x0 to x1 at height y; n x 2.
Eigen::MatrixXd line_points(double x0, double x1, int n, double y);
/// nx x ny grid, x fastest, as Field::points wants it. Throws std::invalid_argument for less than
/// 1 x 1.
Eigen::MatrixXd grid_points(double x0, double x1, int nx, double y0, double y1, int ny);
/// nx x ny x nz grid between two corners of 3 coordinates, x fastest, then y; n x 3. Throws
/// std::invalid_argument for less than 1 x 1 x 1.
Eigen::MatrixXd box_points(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int nx, int ny,
                           int nz);
/// Horizontal cuts: one line_points per height, one after the other.
Eigen::MatrixXd cut_points(double x0, double x1, int n, const std::vector<double>& heights);
/// The same in space: at every height a grid of nx x ny points over the rectangle; n x 3.
Eigen::MatrixXd cut_points(const Eigen::Vector2d& low, const Eigen::Vector2d& high, int nx, int ny,
                           const std::vector<double>& heights);

}  // namespace grainfield::coupling
