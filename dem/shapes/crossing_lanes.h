// Overlaps of polygons side by side, where what a pair remembers still holds: operation by
// operation what overlap_of_shapes (polygon.h) does with Measures::area. All others are left.
#pragma once
#include <cstddef>

#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// What the kernel expects of the engine's rows: numbers of a Body<2>, of which the first are its
/// place and the sixth its radius; pairs of which the feature, of 32 bits, comes after so many
/// bytes.
inline constexpr int kPlaneBody = 8, kPlanePair = 16, kFeatureInPair = 12;

/// Where things are. A block holds a body's corners as OutlineRows says.
struct CrossingRows {
  const double* blocks = nullptr;
  std::size_t block_size = 0;
  int stride = 0;
  int most_corners = 0;          ///< of any body
  const int* corners = nullptr;  ///< how many, by body; 0: a disk
  const double* bodies = nullptr;
  const unsigned char* pairs = nullptr;
};

/// The bits do not depend on W.
template <int W>
void crossing_overlaps_of(const CrossingRows& rows, const RowBatch& batch,
                          PlaneOverlapBatch& overlaps);
inline void crossing_overlaps(const CrossingRows& rows, const RowBatch& batch,
                              PlaneOverlapBatch& overlaps) {
  with_lanes([&](auto width) { crossing_overlaps_of<width()>(rows, batch, overlaps); });
}

}  // namespace grainfield::dem
