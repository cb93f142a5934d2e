// Overlaps side by side: what a shape's kernel writes and a law's reads. Plain numbers.
#pragma once

namespace grainfield::dem {

/// Of so many contacts at once, a multiple of every lane width. Measured: 16 to 64 are alike.
inline constexpr int kBatch = 32;

/// As Overlap3, by slot.
struct alignas(64) OverlapBatch {
  double normal[3][kBatch], depth[kBatch];
  double arm_i[3][kBatch], arm_j[3][kBatch];
  double radius[kBatch], lesser_curvature[kBatch], greater_curvature[kBatch], major[3][kBatch];
};

}  // namespace grainfield::dem
