// Grains that lie upon each other: a wrong unit of the radii, or a period that is too narrow.
#pragma once
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// How many pairs of disks or spheres overlap by more than half the smaller radius, and which is
/// the first; one sentence. Counts up to 10,000. Empty: none.
std::string deep_overlaps(const dem::Snapshot& packing);

}  // namespace grainfield::coupling
