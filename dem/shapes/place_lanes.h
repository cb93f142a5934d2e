// The corners of outlines where their bodies are, for several bodies side by side
// (space/lanes.h): operation by operation what PolygonStore::place does for one.
#pragma once
#include <cstddef>

#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// Where things are. A block holds a body's corners: x and y as the body has them, x and y where
/// they are, `stride` numbers each, a multiple of 4. Sizes count numbers.
struct OutlineRows {
  double* blocks = nullptr;
  std::size_t block_size = 0;
  int stride = 0;
  const double* positions = nullptr;  ///< x and y of the first body, m
  const double* angles = nullptr;     ///< of the first body, rad
  int position_size = 0, angle_size = 0;
};

/// Places bodies list[0] to list[count - 1]. The bits do not depend on W.
template <int W>
void place_outlines_of(const OutlineRows& rows, const int* list, int count);
inline void place_outlines(const OutlineRows& rows, const int* list, int count) {
  with_lanes([&](auto width) { place_outlines_of<width()>(rows, list, count); });
}

}  // namespace grainfield::dem
