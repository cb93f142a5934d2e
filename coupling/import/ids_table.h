// Ids that another program could not have: a table of its own and the original ones.
#pragma once
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Gives the grains, and the loaded one, the ids that the CSV table `file` has beside theirs
/// (columns id and original). Throws std::invalid_argument naming file and line: a missing column,
/// an id or an original that is there twice, a grain that has none.
void restore_ids(const std::string& file, dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
