// Fields of packings that forces of a Python function made (dem/snapshot/added_forces_mark.h).
#pragma once
#include <string>

#include "coupling/field.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Adds the snapshot's attributes of such forces, where there are none yet.
void copy_added_forces(const dem::Snapshot& from, Attributes& to);
/// The forces as a sentence about the field's grains; empty: none.
std::string added_forces_note(const Field& field);

}  // namespace grainfield::coupling
