// The XDMF text that tells ParaView what a file of fields holds.
#pragma once
#include <string>

#include "coupling/output/field_io.h"

namespace grainfield::coupling {

/// `h5_name`: the HDF5 file's name, beside which the text will lie. Grids become structured meshes,
/// scattered points clouds of vertices; every column and its error an attribute on the nodes.
std::string xdmf(const std::string& h5_name, const NamedFields& fields);

}  // namespace grainfield::coupling
