// A field as a table of text.
#pragma once
#include <string>

#include "coupling/field.h"

namespace grainfield::coupling {

/// A comment (#) with the frame and the averaging where the field knows them. One row per point: x
/// (m), y (m) (in space x, y, z; of rings r, z; of heaps in h, their height), then every column
/// with its unit in brackets, and COLUMN_error where there are several realizations; with all
/// digits, nan where there is no value.
std::string field_csv(const Field& field);
/// Writes it, complete or not at all. Throws as write_fields (field_io.h).
void write_field_csv(const std::string& file, const Field& field);

}  // namespace grainfield::coupling
