// Fields in HDF5 and their XDMF description for ParaView (docs/file-formats.md).
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "coupling/base/field.h"

namespace grainfield::coupling {

using NamedFields = std::vector<std::pair<std::string, Field>>;  ///< group name, field

/// Writes every field as a group of one HDF5 file and, beside it, FILE's stem + ".xdmf", each
/// complete or not at all. Names: letters, digits, "_", "-", ".". Throws std::invalid_argument for
/// bad names or a folder that cannot be written.
void write_fields(const std::string& file, const NamedFields& fields);
/// Throws std::invalid_argument, one line: file missing, not HDF5 or truncated, no such field
/// (lists those there), column broken.
Field read_field(const std::string& file, const std::string& name);
/// Numbers that are texts ("0.3", "31.2,30.7") become numbers, and a frame in words its name: files
/// of format 1, h5py and Python have them.
void type_attributes(Attributes& attributes);
/// Names of the fields of the file. Throws as read_field.
std::vector<std::string> list_fields(const std::string& file);

/// `h5_name`: the HDF5 file's name, beside which the text will lie. Grids become structured meshes,
/// scattered points clouds of vertices; every column and its error an attribute on the nodes.
std::string xdmf(const std::string& h5_name, const NamedFields& fields);

}  // namespace grainfield::coupling
