// How a snapshot says that forces of a caller's own (dem/engine/added_forces.h) made it.
#pragma once
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Attributes: names, between commas, of those that act, and of those that acted before.
inline constexpr const char* kAddedForces = "added_forces";
inline constexpr const char* kFormerAddedForces = "former_added_forces";

/// The forces that made a snapshot as a sentence; empty: none.
std::string added_forces_note(const Snapshot& snapshot);
/// The same of the names that act and acted.
std::string added_forces_note(const std::string& now, const std::string& before);
/// Throws std::invalid_argument, beginning with `where`, when forces act that this program does not
/// have: the grains would not go on as they were.
void refuse_added_forces(const Snapshot& snapshot, const std::string& where);

}  // namespace grainfield::dem
