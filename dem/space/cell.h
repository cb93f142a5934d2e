// The cell: which axes repeat, and how the repeated space flows.
#pragma once
#include <array>

#include "dem/space/space.h"

namespace grainfield::dem {

/// A parallelogram (2D) or parallelepiped (3D). Along a periodic axis, what leaves on one side
/// comes in on the other. Without a periodic axis there is no cell: space is bounded by walls
/// alone.
template <int D>
struct Cell {
  using Matrix = Eigen::Matrix<double, D, D, Eigen::DontAlign>;
  std::array<bool, D> periodic{};
  PlainVector<D> low = PlainVector<D>::Zero();  ///< corner where the edges begin, m
  /// Columns: the edges, m; the image n of a place lies at x + edges n.
  Matrix edges = Matrix::Zero();
  /// L, 1/s: the edges follow edges' = L edges; an image moves faster than its origin by L edges n.
  Matrix velocity_gradient = Matrix::Zero();

  bool is_periodic() const {
    for (const bool axis : periodic) {
      if (axis) return true;
    }
    return false;
  }
};

}  // namespace grainfield::dem
