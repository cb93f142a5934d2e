// A packing as the tables that `import --from csv` reads.
#pragma once
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct PackingTables {
  std::string grains, contacts, walls;  ///< CSV with a header, SI, all digits; walls may be empty
};

/// Its grains, contacts and plane walls. Forces of a Python function that act are told by a comment
/// above each table. Throws std::invalid_argument for what the tables have no
/// column for: superellipsoids, walls of other shapes, periodic cells.
PackingTables packing_tables(const dem::Snapshot& packing);

}  // namespace grainfield::coupling
