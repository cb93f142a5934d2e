// Where to average: grids, lines, horizontal cuts, and heaps scaled to their height.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// n equally spaced points from x0 to x1 at height y; n x 2.
Eigen::MatrixXd line_points(double x0, double x1, int n, double y);
/// n equally spaced points from a to b, both of 2 (3) coordinates; n x 2 (3). Throws
/// std::invalid_argument for n < 1 or ends of different dimension.
Eigen::MatrixXd segment_points(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int n);
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

/// A heap as models see it, scaled: origin at the apex, lengths in units of its height, inside is
/// y < 0 down to y = -1. Points with the same scaled coordinates are the same place in piles of
/// slightly different height, so that ensembles average properly.
struct HeapFrame {
  double apex_x = 0;                       ///< abscissa where the flanks' lines meet, m
  double floor = 0;                        ///< m
  double height = 1;                       ///< highest point of the free surface above the floor, m
  double left = 0, right = 0;              ///< abscissas of the outermost grains' edges, m
  double left_slope = 0, right_slope = 0;  ///< of the flanks' lines, both positive for a heap

  /// From scaled coordinates to the packing's axes; n x 2, m.
  Eigen::MatrixXd to_packing(const Eigen::MatrixXd& scaled) const;
  /// From the packing's axes to scaled coordinates; n x 2.
  Eigen::MatrixXd to_scaled(const Eigen::MatrixXd& packing_points) const;
};

/// Measures a heap: the flanks' lines are least squares through the free surface (region.h) between
/// 15 % and 85 % of the height to either side of the highest point. With fewer than two such
/// corners on a side, or lines that do not meet between the outermost grains, the apex is the
/// highest point. Throws std::invalid_argument for 3D snapshots or without a free grain.
HeapFrame heap_frame(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
