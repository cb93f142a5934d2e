// Files by their endings: nobody finds HDF5 under a name that says CSV.
#pragma once
#include <string>
#include <vector>

#include "coupling/output/field_io.h"

namespace grainfield::coupling {

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
