// Numbers that the text of the physics is written over: a double, W of them side by side (lanes.h),
// or one with derivatives (Eigen's AutoDiffScalar). Where a text branches, it chooses by a mask: of
// one number a bool. What only spares work, and what one number alone can do, it asks are_lanes
// for.
#pragma once
#include <cmath>
#include <type_traits>

#include "dem/space/lanes.h"

namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS {

template <class N>
inline constexpr bool are_lanes = !std::is_class_v<N> && !std::is_arithmetic_v<N>;
template <class N>
inline constexpr int lanes_in = sizeof(N) / sizeof(double);
/// What a comparison gives.
template <class N>
using MaskOf = decltype(N{} < N{});

template <class N>
[[gnu::always_inline]] inline N root(const N& x) {
  if constexpr (are_lanes<N>) {
    return root_of<lanes_in<N>>(x);
  } else {
    using std::sqrt;
    return sqrt(x);
  }
}
/// One number is true, or any lane.
template <class M>
[[gnu::always_inline]] inline bool any(const M& mask) {
  if constexpr (std::is_arithmetic_v<M>) {
    return mask != 0;
  } else {
    return any_of(mask);
  }
}
template <class M>
[[gnu::always_inline]] inline auto opposite(const M& mask) {
  if constexpr (std::is_arithmetic_v<M>) {
    return mask == 0;
  } else {
    return ~mask;
  }
}
/// Of numbers or of vectors.
template <class M, class T>
[[gnu::always_inline]] inline T chosen(const M& mask, const T& a, const T& b) {
  return mask ? a : b;
}
template <class T>
[[gnu::always_inline]] inline auto same(const T& a, const T& b) {
  return a == b;
}

}  // namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS
