// Tables of numbers that a run recorded on the way to a state, in the state's HDF5 group.
#pragma once
#include <hdf5.h>

#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// tables/NAME/COLUMN: a dataset a column, with its unit; attribute "columns" of NAME: their order.
/// Throws StorageFailed.
void write_number_tables(hid_t group, const Snapshot& snapshot);
/// The same back, and columns that files of version 0.9.0 may hold as texts of numbers in
/// attributes (gas:COLUMN, pair:COLUMN, settling:COLUMN, switch:COLUMN), which leave the
/// attributes. Throws std::invalid_argument naming `where` and what is missing, damaged or of
/// another length.
void read_number_tables(hid_t group, const std::string& where, Snapshot& snapshot);

}  // namespace grainfield::dem
