// The free surface of a packing in space: a height over the plane.
#pragma once
#include <Eigen/Core>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Heights at the middles of square columns, bilinear between them and level beyond the outer ones.
class Roof {
 public:
  /// Level everywhere, at this height, m.
  explicit Roof(double height);
  /// The highest edges of the free grains in columns about `column` wide over the rectangle from
  /// `low` to `high`; a column without a grain has the height low.z().
  Roof(const dem::Snapshot& snapshot, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
       double column);

  double height(double x, double y) const;
  double highest() const { return heights_.maxCoeff(); }
  /// Mean over the columns that hold a grain.
  double mean() const { return mean_; }
  /// No point of the surface over this rectangle is lower.
  double lowest(double x0, double x1, double y0, double y1) const;
  /// Heights by column, x along the rows of the matrix.
  const Eigen::MatrixXd& heights() const { return heights_; }
  /// Middle of a column, m.
  Eigen::Vector2d middle(Eigen::Index column_x, Eigen::Index column_y) const;

 private:
  Eigen::Vector2d low_{0, 0}, size_{1, 1};  // corner and extents of a column
  Eigen::MatrixXd heights_;
  double mean_ = 0;
};

}  // namespace grainfield::coupling
