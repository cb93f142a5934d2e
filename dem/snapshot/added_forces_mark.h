// How a snapshot says that forces of a caller's own (dem/engine/added_forces.h) made it.
#pragma once
#include <map>
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Attributes: names, between commas, of those that act, and of those that acted before.
inline constexpr const char* kAddedForces = "added_forces";
inline constexpr const char* kFormerAddedForces = "former_added_forces";

/// The forces that made a snapshot, or the field that was averaged over it, of these attributes, as
/// a sentence; empty: none.
std::string added_forces_note(const std::map<std::string, std::string>& attributes);
/// Copies those attributes to the ones of what was made of the snapshot, where it has none yet.
void copy_added_forces(const std::map<std::string, std::string>& from,
                       std::map<std::string, std::string>& to);
/// Throws std::invalid_argument, beginning with `where`, when forces act that this program does not
/// have: the grains would not go on as they were.
void refuse_added_forces(const Snapshot& snapshot, const std::string& where);

}  // namespace grainfield::dem
