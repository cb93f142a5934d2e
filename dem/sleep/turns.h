// Small turns between rotations, in the plane and in space.
#pragma once
#include <type_traits>

#include "dem/space/space.h"

namespace grainfield::dem {

/// The turn (rad; in space its direction is the axis) that brings one rotation into another. To
/// first order in space.
template <int D>
SpinOf<D> turn_between(const RotationOf<D>& from, const RotationOf<D>& to) {
  if constexpr (D == 2) {
    return to - from;
  } else {
    const RotationOf<D> q = to * from.conjugate();
    return (q.w() < 0 ? -2.0 : 2.0) * q.vec();
  }
}

/// A rotation, turned by so much. To first order in space.
template <int D>
RotationOf<D> turned_by(const RotationOf<D>& rotation, const SpinOf<D>& turn) {
  if constexpr (D == 2) {
    return rotation + turn;
  } else {
    return (RotationOf<D>(1, 0.5 * turn.x(), 0.5 * turn.y(), 0.5 * turn.z()) * rotation)
        .normalized();
  }
}

}  // namespace grainfield::dem
