// Which grains or pairs the rows of a table are of, to tell pieces of one table from repeated ones.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "coupling/import/table.h"

namespace grainfield::coupling {

/// Ids of grains, or pairs of bodies in any order; sorted, each once.
using RowKeys = std::vector<std::string>;

/// Keys of the rows of a table. Empty without a column of them, or if the table cannot be read.
RowKeys row_keys(const ForeignTable& table, TableKind kind, ColumnNames& names,
                 TableReader& reader);

/// Which cubes of three mean diameters the grains of a table lie in, as row_keys().
RowKeys place_keys(const ForeignTable& table, ColumnNames& names, TableReader& reader);

/// Whether two tables have nearly all rows of their own: less than half of the smaller one are in
/// the other. False where one is empty.
bool are_apart(const RowKeys& a, const RowKeys& b);

/// Reads row_keys() of a table.
using ReadKeys = std::function<RowKeys(const ForeignTable&, TableKind)>;

}  // namespace grainfield::coupling
