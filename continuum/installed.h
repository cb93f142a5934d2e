// Where an installed grainfield keeps what belongs to it.
#pragma once
#include <filesystem>
#include <vector>

namespace grainfield::continuum {

/// Folders whose lib/grainfield and share/grainfield may be ours, nearest first: that of the
/// environment's GRAINFIELD_PREFIX alone where it is set, for programs that link an installation
/// from elsewhere; else the one above the program's own; of a module in another program (a Python
/// interpreter) all above the module.
std::vector<std::filesystem::path> installed_prefixes();

}  // namespace grainfield::continuum
