// Numbers side by side, for code that does the same to each: W of them in a vector of the
// processor, or in several. Each comes out with the bits that it would have alone.
//
// Files that include this are compiled once for each width (dem/CMakeLists.txt), for processors
// that not every machine has: they share no inline function with other files.
#pragma once
#if defined(__x86_64__)
#include <immintrin.h>
#endif
#include <cstdint>

// Where the build does not say otherwise, what every processor has.
#ifndef GRAINFIELD_LANES
#define GRAINFIELD_LANES 2
#endif

namespace grainfield::dem {

template <int W>
struct LanesOf {
  typedef double Numbers __attribute__((vector_size(8 * W)));
  typedef std::int64_t Masks __attribute__((vector_size(8 * W)));
  typedef std::uint64_t Bits __attribute__((vector_size(8 * W)));
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
#if defined(__x86_64__)
  if constexpr (W == 2) return reinterpret_cast<Lanes<W>>(_mm_sqrt_pd(x));
#endif
#if defined(__AVX__)
  if constexpr (W == 4) return reinterpret_cast<Lanes<W>>(_mm256_sqrt_pd(x));
#endif
#if defined(__AVX512F__)
  // With a mask of all: the header of the other one warns of what it leaves unset (GCC 12).
  if constexpr (W == 8) return reinterpret_cast<Lanes<W>>(_mm512_maskz_sqrt_pd(0xFF, x));
#endif
  return lanes_of<W>([&](int k) { return __builtin_sqrt(x[k]); });
}
/// W numbers in a row, of memory.
template <int W>
[[gnu::always_inline]] inline Lanes<W> loaded(const double* from) {
  Lanes<W> out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}
template <int W>
[[gnu::always_inline]] inline void store(const Lanes<W>& x, double* to) {
  __builtin_memcpy(to, &x, sizeof x);
}
template <class M>
[[gnu::always_inline]] inline bool any_of(const M& mask) {
#if defined(__AVX512DQ__)
  if constexpr (sizeof(M) == 64) return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)) != 0;
#endif
#if defined(__AVX__)
  if constexpr (sizeof(M) == 32) return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask)) != 0;
#endif
  std::int64_t any = 0;
  for (unsigned k = 0; k < sizeof(M) / 8; ++k) any |= mask[k];
  return any != 0;
}

/// Bit k: lane k of a mask.
template <class M>
[[gnu::always_inline]] inline std::uint64_t bits_of(const M& mask) {
#if defined(__AVX512DQ__)
  if constexpr (sizeof(M) == 64) return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
#endif
#if defined(__AVX__)
  if constexpr (sizeof(M) == 32) {
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
  }
#endif
  std::uint64_t bits = 0;
  for (unsigned k = 0; k < sizeof(M) / 8; ++k) bits |= static_cast<std::uint64_t>(mask[k] & 1) << k;
  return bits;
}
/// Bit k: lane k of x is above 0.
template <int W>
[[gnu::always_inline]] inline std::uint64_t positive_bits(const Lanes<W>& x) {
#if defined(__AVX512DQ__)
  if constexpr (W == 8) return _mm512_cmp_pd_mask(x, _mm512_setzero_pd(), _CMP_GT_OQ);
#endif
  return bits_of(x > 0);
}
/// Bit k: lane k of x is not below 0, and a number.
template <int W>
[[gnu::always_inline]] inline std::uint64_t unsigned_bits(const Lanes<W>& x) {
#if defined(__AVX512DQ__)
  if constexpr (W == 8) return _mm512_cmp_pd_mask(x, _mm512_setzero_pd(), _CMP_GE_OQ);
#endif
  return bits_of(x >= 0);
}
/// Each lane has the next one's number; the last keeps its own.
template <int W>
[[gnu::always_inline]] inline Lanes<W> next_lanes(const Lanes<W>& x) {
  if constexpr (W == 2) {
    return __builtin_shufflevector(x, x, 1, 1);
  } else if constexpr (W == 4) {
    return __builtin_shufflevector(x, x, 1, 2, 3, 3);
  } else {
    return __builtin_shufflevector(x, x, 1, 2, 3, 4, 5, 6, 7, 7);
  }
}

}  // namespace grainfield::dem
