// Columns beside each other over a packing's width.
#pragma once
#include <cstddef>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Whole columns of about this width (m) between two places along an axis, at least 1. Throws
/// std::invalid_argument where they are more than `most`: the message names the free grain that is
/// furthest from the others.
std::size_t count_columns(const dem::Snapshot& snapshot, int axis, double from, double to,
                          double column, double most = 1e6);

}  // namespace grainfield::coupling
