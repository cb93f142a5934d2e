// Files and fields of packings that forces of a Python function made, and how they say so
// (dem/snapshot/added_forces_mark.h).
#pragma once
#include <map>
#include <string>

#include "coupling/base/field.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Adds the snapshot's attributes of such forces, where there are none yet.
void copy_added_forces(const dem::Snapshot& from, Attributes& to);
/// The attributes of such forces alone, by their names; empty: no such force.
std::map<std::string, std::string> added_forces_of(const dem::Snapshot& packing);
std::map<std::string, std::string> added_forces_of(const Field& field);
/// The forces as a sentence about the field's grains; empty: none.
std::string added_forces_note(const Field& field);

/// The sentence as a comment line of a table or a deck, "# ...\n"; empty without such forces.
template <class Held>
std::string added_forces_comment(const Held& held);
/// A <FieldData> of a VTK file with an array named "added_forces: glue, wind"; empty without such
/// forces. In the name because readers such as meshio refuse arrays of text.
template <class Held>
std::string added_forces_in_vtk(const Held& held);

}  // namespace grainfield::coupling
