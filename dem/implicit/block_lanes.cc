// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/implicit/block_lanes.h"

#include "dem/space/lanes.h"

namespace grainfield::dem {

template <int W>
void take_row_of(const PaddedBlock& factor, const PaddedBlock* row, const int* columns, int count,
                 const int* places, PaddedBlock* values) {
  using V = Lanes<4>;  // a column: one vector or, where there is none of four, two
  const V first = loaded<4>(factor.numbers), second = loaded<4>(factor.numbers + 4),
          third = loaded<4>(factor.numbers + 8);
  for (int q = 0; q < count; ++q) {
    const double* from = row[q].numbers;
    double* to = values[places[columns[q]]].numbers;
    for (int column = 0; column < 12; column += 4) {
      const V part = first * from[column] + second * from[column + 1] + third * from[column + 2];
      store<4>(loaded<4>(to + column) - part, to + column);
    }
  }
}
template void take_row_of<GRAINFIELD_LANES>(const PaddedBlock&, const PaddedBlock*, const int*, int,
                                            const int*, PaddedBlock*);

}  // namespace grainfield::dem
