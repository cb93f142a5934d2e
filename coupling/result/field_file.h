// Fields as files by their endings, HDF5 or a table of text: nobody finds HDF5 under a name that
// says CSV.
#pragma once
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/store/field_io.h"

namespace grainfield::coupling {

/// A comment (#) with the frame and the averaging where the field knows them. One row per point: x
/// (m), y (m) (in space x, y, z; of rings r, z; of heaps in h, their height), then every column
/// with its unit in brackets, and COLUMN_error where there are several realizations; with all
/// digits, nan where there is no value.
std::string field_csv(const Field& field);
/// Writes it, complete or not at all. Throws as write_fields (field_io.h).
void write_field_csv(const std::string& file, const Field& field);

/// Throws std::invalid_argument "OPTION: found q.txt, allowed: ..." unless the file's name has one
/// of these endings (".csv") or none at all. `what`: "tables".
void require_ending(const std::string& option, const std::string& file,
                    const std::vector<std::string>& endings, const std::string& what);
/// The same for fields: .h5, .hdf5, .csv or none, which is HDF5.
void require_field_ending(const std::string& option, const std::string& file);

/// Writes the fields as HDF5 with the XDMF beside it, or where the name ends in .csv the first one
/// as a table; complete or not at all. Returns what a table leaves out, a sentence; empty: nothing.
/// Throws as write_fields and require_field_ending.
std::string write_field_file(const std::string& file, const NamedFields& fields);

}  // namespace grainfield::coupling
