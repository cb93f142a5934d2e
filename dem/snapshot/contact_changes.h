// What a load did to the contact network.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

struct ContactChanges {
  int gained = 0;         ///< contacts with force after, without before
  int lost = 0;           ///< the other way round
  int newly_sliding = 0;  ///< there before and after, at the Coulomb limit only after
  double max_displacement_over_radius = 0;
};

/// Compares two states of the same grains; throws std::invalid_argument when they are not.
ContactChanges compare_contacts(const Snapshot& before, const Snapshot& after);

/// Force of the base (walls named "floor", fixed grains) on the free grains, N: its upward part, y
/// in the plane and z in space, is the load that the base carries.
Vec3 base_force(const Snapshot& snapshot);

}  // namespace grainfield::dem
