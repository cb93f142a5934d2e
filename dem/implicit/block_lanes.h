// The inner loop of BlockLu: a row of 3 by 3 blocks times a block, taken from another row.
#pragma once
#include "dem/space/lane_width.h"

namespace grainfield::dem {

/// A 3 by 3 block by columns, each filled up to four numbers with 0.
struct alignas(32) PaddedBlock {
  double numbers[12] = {};
};

/// values[places[columns[q]]] -= factor row[q] for q below `count`. The bits do not depend on W.
template <int W>
void take_row_of(const PaddedBlock& factor, const PaddedBlock* row, const int* columns, int count,
                 const int* places, PaddedBlock* values);

}  // namespace grainfield::dem
