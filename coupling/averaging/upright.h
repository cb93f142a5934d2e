// Packings whose height is not along the last axis, turned so that it is.
//
// Layers, heaps and loads are measured along y in the plane and along z in space. A packing of
// another program may have any axis up: which one its gravity says, or without gravity the force
// on its loaded grain, or the user.
#pragma once
#include <memory>
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Words of --up: "x", "-x", "y", "-y", "z", "-z"; "": as the packing says.
bool is_up(const std::string& word);

/// Unit vector against the packing's gravity, or against the applied force; `asked` before both;
/// zero where there is neither. Throws std::invalid_argument "--up: ..." for another word, z in the
/// plane, and gravity along no axis.
dem::Vec3 up_of(const dem::Snapshot& snapshot, const std::string& asked);

/// The packing turned so that `up`, along an axis, is y (in space z); itself where it is. Throws
/// std::invalid_argument for a tilted periodic cell that would have to be turned.
std::shared_ptr<const dem::Snapshot> upright(std::shared_ptr<const dem::Snapshot> snapshot,
                                             const dem::Vec3& up);

}  // namespace grainfield::coupling
