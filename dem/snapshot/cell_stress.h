// The mean stress of a periodic cell, without any averaging window.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Tension positive, Pa; in 2D N/m, with third row and column 0.
struct CellStress {
  Eigen::Matrix3d contacts;  ///< (1/V) sum over contacts f (x) l
  Eigen::Matrix3d motion;    ///< -(1/V) sum over grains m u (x) u
  Eigen::Matrix3d total() const { return contacts + motion; }
};

/// Love (1927) and Irving and Kirkwood (1950): f the force on grain i, l the branch from i to the
/// image of j that it touches, u the velocity against the cell's flow, V the cell's volume (area in
/// 2D). The flow's power on the grains is V total : L. Throws std::invalid_argument when the
/// snapshot is not periodic along every axis.
CellStress cell_stress(const Snapshot& snapshot);

/// Volume of a cell periodic along every axis of `dim` dimensions, m3 (m2 in 2D). Throws likewise.
double cell_volume(const Cell<3>& cell, int dim);

}  // namespace grainfield::dem
