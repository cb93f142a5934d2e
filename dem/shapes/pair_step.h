// The short steps of Newton's that pairs in contact take (common_normal.h), several pairs side by
// side. A pair's results do not depend on what shares the batch, nor on the width of the lanes.
#pragma once
#include "dem/shapes/dual_norm.h"
#include "dem/space/lane_width.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

// A step is the last one when it would change the depth by less than this share of it, and the
// points lie across each other within this share of both sizes: what is left of the depth is of
// third order.
inline constexpr double kDepthLeft = 1e-9, kPointsLeft = 1e-4;

/// A superellipsoid and how it is turned, as plain numbers.
struct alignas(64) LaneBody {
  double turn[3][3];      ///< the body's axes in space, one after the other
  double axes[3];         ///< semi-axes, m
  double level, upright;  ///< powers P and Q
  double farthest;        ///< point of the surface from the centre, m
  double equal_radius;    ///< of the sphere of equal volume, m
};

enum class Stepped {
  settled,  ///< the contact is found
  apart,    ///< the normal proves it
  neither   ///< more has to be done than a few short steps
};

/// Pairs that touched in the step before, by slot: those named in `slots`.
struct PairBatch {
  int count = 0;
  int slots[kBatch];
  const LaneBody *i[kBatch], *j[kBatch];
  double across[3][kBatch];    ///< D, m
  PairPowers* powers[kBatch];  ///< carried on
  /// In: the remembered normals. Out, settled: all of the overlap (with curvatures); apart: the
  /// normal that proves it.
  OverlapBatch* overlaps = nullptr;
  double height[kBatch];  ///< out: f at the last normal looked at, m
  Stepped ends[kBatch];
  int evaluations[kBatch];
};

/// From the remembered normals by at most three steps. The bits do not depend on W.
template <int W>
void step_pairs_of(PairBatch& batch, bool curvatures);
inline void step_pairs(PairBatch& batch, bool curvatures) {
  with_lanes([&](auto width) { step_pairs_of<width()>(batch, curvatures); });
}

}  // namespace grainfield::dem
