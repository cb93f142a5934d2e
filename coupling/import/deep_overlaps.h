// Grains that a period narrower than the packing has laid upon each other.
#pragma once
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// How many pairs of round grains of a periodic packing overlap by more than half the smaller
/// radius, and which is the first; one sentence. Counts up to 10,000. Empty: none, or no cell.
std::string deep_overlaps(const dem::Snapshot& packing);

}  // namespace grainfield::coupling
