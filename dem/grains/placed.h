// Grains of the plane where they are.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Corners of a grain where it is, m, counter-clockwise; empty for a disk.
Outline placed_outline(const Grain& grain);
/// Height of a grain's highest point, m.
double top_of(const Grain& grain);

}  // namespace grainfield::dem
