// A half space: what lies behind a plane.
#pragma once
#include "dem/space/space.h"

namespace grainfield::dem {

template <int D>
struct Plane {
  VectorOf<D> point = zero<VectorOf<D>>();   ///< on it, m
  VectorOf<D> normal = zero<VectorOf<D>>();  ///< unit, out of what lies behind

  /// Height of a point in front of the plane, m; behind it below 0.
  double height(const VectorOf<D>& at) const { return (at - point).dot(normal); }
};

}  // namespace grainfield::dem
