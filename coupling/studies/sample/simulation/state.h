// What a sample is like at a moment: its size, its stress, and what its walls feel.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

struct SampleState {
  /// Edges as columns, m; between walls those of the box, which may be tilted. In 2D the third is
  /// 0.
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero();
  double volume = 0;          ///< m3 (m2)
  double solid_fraction = 0;  ///< volume of the grains over it; overlaps count twice
  /// Tension positive, Pa (N/m): (1/V) (sum f (x) l - sum m u (x) u); l the branch from i to the
  /// image of j that it touches, or to the contact point on a wall; u the velocity against the
  /// cell's flow.
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
  /// The first sum alone (Love 1927, Weber 1966).
  Eigen::Matrix3d contact_stress = Eigen::Matrix3d::Zero();
  /// Pressure of the grains on the walls across each axis, the mean of the two opposite ones,
  /// compression positive, Pa (N/m); nan in a cell.
  Vec3 wall_pressure{0, 0, 0};
  Vec3 moved_pressure{0, 0, 0};  ///< of those that servos lead: right, back and lid alone
  /// Force of the grains on the lid along x over the floor's area, Pa (N/m); nan in a cell.
  double lid_shear = 0;
};

/// State of a sample's snapshot: periodic along every axis, or between the walls of box_walls
/// (walls/box.h), left and right perhaps tilted about the axis that is neither x nor the last one.
/// Throws std::invalid_argument when it is neither.
SampleState sample_state(const Snapshot& snapshot);

}  // namespace grainfield::dem
