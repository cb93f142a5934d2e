// What is said of the columns of a table that the import did not take.
#pragma once
#include <string>
#include <vector>

#include "coupling/import/table.h"

namespace grainfield::coupling {

struct UntakenColumns {
  std::string note;                   ///< names all of them; empty: none
  std::vector<std::string> warnings;  ///< of those whose names tell of something that counts
};
/// What a table of `kind` holds besides the columns looked up. Names of forces and torques
/// between grains, of velocities, images, shapes, orientations and units are warned of, unless the
/// table tells the same by a column that was taken.
UntakenColumns untaken_columns(const ForeignTable& table, const TableColumns& columns,
                               TableKind kind);

/// "a", "c[1]", "c[2]" -> "a c[1..2]"; after some of them how many more there are.
std::string grouped_names(const std::vector<std::string>& names);

/// A name in lower case without signs, and without what made it: "c_quat[1]" of a dump -> "quat1".
std::string plain_untaken_name(const ForeignTable& table, const std::string& name);

}  // namespace grainfield::coupling
