// Which grains belong to a heap: those that its floor carries.
#pragma once
#include <cstddef>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Whether a chain of contacts ties each grain to a wall or a fixed grain; where none is
/// tied so (contacts with the floor not known), whether it is in the largest group of grains that
/// touch one another. Without contacts nothing is known: all.
std::vector<bool> carried_grains(const dem::Snapshot& snapshot);

/// Indices of the free grains in flight: not carried, and with their centre above the surface of
/// the carried ones, or beside it. Grains without contacts inside the heap (rattlers) are not.
/// `column`: width of the surface's columns, m, above 0.
std::vector<std::size_t> grains_in_flight(const dem::Snapshot& snapshot, double column);

}  // namespace grainfield::coupling
