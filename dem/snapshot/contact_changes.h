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

/// Force of the grains on the base (flat floor and fixed grains), N, as the base feels it with the
/// sign turned: y > 0 is the load it carries.
Vec3 base_force(const Snapshot& snapshot);

}  // namespace grainfield::dem
