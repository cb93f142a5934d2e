// What the contacts of a packing tell of the forces on its walls.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Force and torque of every wall become those of its contacts, against rolling and twisting of
/// their springs alone. Contacts of unknown grains or walls are passed over.
void set_wall_forces(Snapshot& snapshot);

}  // namespace grainfield::dem
