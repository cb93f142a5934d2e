// Numbers side by side, for code that does the same to each: W of them in a vector of the
// processor, or in several. Each comes out with the bits that it would have alone.
#pragma once
#include <cmath>
#include <cstdint>

namespace grainfield::dem {

template <int W>
struct LanesOf {
  typedef double Numbers __attribute__((vector_size(8 * W)));
  typedef std::int64_t Masks __attribute__((vector_size(8 * W)));
};
template <int W>
using Lanes = typename LanesOf<W>::Numbers;

/// get(lane) by lane.
template <int W, class Get>
[[gnu::always_inline]] inline Lanes<W> lanes_of(Get get) {
  Lanes<W> out;
  for (int k = 0; k < W; ++k) out[k] = get(k);
  return out;
}
template <class V>
[[gnu::always_inline]] inline V magnitude(const V& x) {
  return x < 0 ? -x : x;
}
template <class V>
[[gnu::always_inline]] inline V greater_of(const V& x, const V& y) {
  return x > y ? x : y;
}
/// The size of x, the sign of y; of 0 that of +0.
template <class V>
[[gnu::always_inline]] inline V with_sign(const V& x, const V& y) {
  return y < 0 ? -x : x;
}
template <int W>
[[gnu::always_inline]] inline Lanes<W> root_of(const Lanes<W>& x) {
  Lanes<W> out;
  for (int k = 0; k < W; ++k) out[k] = std::sqrt(x[k]);
  return out;
}
/// Neighbours 0 and 1, 2 and 3, ... in each other's place.
template <int W>
[[gnu::always_inline]] inline Lanes<W> swapped(const Lanes<W>& x) {
  typename LanesOf<W>::Masks order;
  for (int k = 0; k < W; ++k) order[k] = k ^ 1;
  return __builtin_shuffle(x, order);
}
template <class M>
[[gnu::always_inline]] inline bool any_of(const M& mask) {
  std::int64_t any = 0;
  for (unsigned k = 0; k < sizeof(M) / 8; ++k) any |= mask[k];
  return any != 0;
}

}  // namespace grainfield::dem
