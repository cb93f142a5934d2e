// What the last relaxation of a pile changes: grains may have slept before it, all are awake in it.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// The vertical force that the grains below a level exert on those above it, over the weight of
/// these, minus one. 0 where what is above is in balance. Grains belong to the side on which their
/// centroid is; contacts between the two sides count. nan without a grain above.
double weight_carried_error(const dem::Snapshot& snapshot, double level);

struct Relaxation {
  double base_before = 0;    ///< base force over the weight of all grains
  double levels_before = 0;  ///< largest |weight_carried_error| over the levels
  double levels_after = 0;
  double forces = 0;  ///< sum of the changes of the contacts' forces over the sum of the forces
                      ///< before; a contact that opens or closes changes by its whole force
  double mean_displacement = 0, largest_displacement = 0;  ///< over `diameter`
};

/// Levels: from the base up in steps of a tenth of the height of the highest grain that moves, as
/// long as a twentieth of the weight is above. Throws std::invalid_argument when the two are not of
/// the same grains, or none of them can move.
Relaxation measure_relaxation(const dem::Snapshot& before, const dem::Snapshot& after,
                              double diameter);

}  // namespace grainfield::coupling
