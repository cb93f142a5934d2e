// Attributes of fields in HDF5 (docs/file-formats.md).
#pragma once
#include <string>

#include "coupling/base/field.h"
#include "dem/hdf5/file.h"

namespace grainfield::coupling {

/// Texts and numbers as attributes of the field's group, numbers of each realization as datasets.
void write_attributes(hid_t group, const Field& field);
/// Throws std::invalid_argument naming `where` for what is damaged.
Attributes read_attributes(hid_t group, const std::string& where);

}  // namespace grainfield::coupling
