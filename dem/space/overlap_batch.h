// Overlaps side by side: what a shape's kernel writes and a law's reads. Plain numbers.
#pragma once

namespace grainfield::dem {

/// Contacts of a batch, a multiple of every lane width. Measured: 16 to 64 are alike.
inline constexpr int kBatch = 32;

/// As Overlap3, by slot.
struct alignas(64) OverlapBatch {
  double normal[3][kBatch], depth[kBatch];
  double arm_i[3][kBatch], arm_j[3][kBatch];
  double radius[kBatch], lesser_curvature[kBatch], greater_curvature[kBatch], major[3][kBatch];
};

/// So many pairs behind the last one may be looked at; their forces go nowhere.
inline constexpr int kPairsBehind = 32;

/// Pairs of the list, at most kBatch, with both grains of each.
struct RowBatch {
  /// By place, kPairsBehind more behind the last.
  const int *first = nullptr, *second = nullptr, *pair = nullptr;
  int count = 0;
};

/// What is known of a pair.
enum class PairFate : unsigned char {
  apart,
  touches,
  left  ///< nothing: to be done alone
};

/// Pairs that touch, as Overlap, one after the other.
struct alignas(64) PlaneOverlapBatch {
  double nx[kBatch], ny[kBatch], area[kBatch], chord[kBatch], length[kBatch];
  double arm_i[kBatch], arm_j[kBatch], lever_i[kBatch], lever_j[kBatch];
  double shift_i[kBatch], shift_j[kBatch];
  int count = 0;
  int slot[kBatch], place[kBatch];  ///< in the batch of one that touches here; here of one there
  PairFate state[kBatch];           ///< by slot
};

}  // namespace grainfield::dem
