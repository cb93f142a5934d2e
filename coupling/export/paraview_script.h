// Scripts that open exported files in ParaView, dressed: `paraview --script=STEM-paraview.py`.
#pragma once
#include <string>

#include "coupling/field.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Of STEM-grains.vtu, STEM-contacts.vtu and STEM-chains.vtu beside it: grains coloured by their
/// pressure (spheres as balls of their radius), contacts by their normal force, chains hidden.
std::string paraview_of_packing(const std::string& stem, const dem::Snapshot& packing);
/// Of STEM.vtu beside it, coloured by the column, or the first where there is none of that name.
std::string paraview_of_field(const std::string& stem, const Field& field,
                              const std::string& column);

}  // namespace grainfield::coupling
