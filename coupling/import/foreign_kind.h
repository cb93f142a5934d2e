// Kind of a file of text, by its beginning.
#pragma once
#include <string>
#include <string_view>

namespace grainfield::coupling {

/// What a file that begins with this line is, and how it is read, for a refusal: "a dump of LAMMPS
/// or LIGGGHTS: --from lammps, --from liggghts". Empty: not known, or a file of `format`.
std::string foreign_kind(std::string_view line, std::string_view format);

}  // namespace grainfield::coupling
