// Where two disks or spheres touch, of one pair and of several side by side (number.h): the lens
// that they share has its chord, or the circle that is its edge, at lever_i from the centre of the
// first, on the line of centres. One inside the other: the point is the smaller one's centre.
#pragma once
#include "dem/space/overlap.h"

namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS {

/// How two disks lie.
template <class N>
struct DisksMeet {
  MaskOf<N> apart, inside{};  ///< inside: one in the other, or about the same centre
  N sag_i{};                  ///< of the chord, r_i - arm_i, m
};
template <class N>
[[gnu::always_inline]] inline MaskOf<N> disks_apart(const N& dx, const N& dy, const N& ri,
                                                    const N& rj) {
  const N squared = dx * dx + dy * dy, reach = ri + rj;
  return squared >= reach * reach;
}
/// Fills normal, depth and arms for two disks whose centres are (dx, dy) apart, from the first to
/// the second; of those that are apart with anything.
template <class N>
[[gnu::always_inline]] inline DisksMeet<N> disks_meet(const N& dx, const N& dy, const N& ri,
                                                      const N& rj, Overlap2Of<N>& o) {
  const N squared = dx * dx + dy * dy, reach = ri + rj, none = zero<N>();
  DisksMeet<N> out{disks_apart(dx, dy, ri, rj)};
  const N distance = root(squared), inverse = 1 / distance;
  o.depth = reach - distance;
  // Sagitta of each segment, without cancellation: r_i - arm_i = depth (2 r_j - depth) / (2 d).
  out.sag_i = o.depth * (2 * rj - o.depth) * (0.5 * inverse);
  const N sag_j = o.depth - out.sag_i;
  o.nx = dx * inverse;
  o.ny = dy * inverse;
  o.arm_i = ri - out.sag_i;
  o.arm_j = rj - sag_j;
  const auto beside = distance > magnitude(N(ri - rj)) + 1e-12 * reach;
  out.inside = opposite(beside | out.apart);
  if (any(out.inside)) [[unlikely]] {
    const auto together = out.inside & (distance == 0);
    const N arm = ri < rj ? none : distance;
    o.nx = chosen(together, N(none + 1), o.nx);
    o.ny = chosen(together, none, o.ny);
    o.arm_i = chosen(out.inside, arm, o.arm_i);
    o.arm_j = chosen(out.inside, N(distance - arm), o.arm_j);
  }
  return out;
}

/// How two spheres lie.
template <class N>
struct SpheresMeet {
  MaskOf<N> apart;
  N lever_i{}, lever_j{};  ///< of the contact point along the normal, from either centre, m
};
template <class N>
[[gnu::always_inline]] inline MaskOf<N> spheres_apart(const VectorOf<3, N>& across, const N& ri,
                                                      const N& rj) {
  const N reach = ri + rj;
  return across.squaredNorm() >= reach * reach;
}
/// Fills normal, depth and radius for two spheres whose centres are `across` apart.
template <class N>
[[gnu::always_inline]] inline SpheresMeet<N> spheres_meet(const VectorOf<3, N>& across, const N& ri,
                                                          const N& rj, Overlap3Of<N>& o) {
  using V = VectorOf<3, N>;
  const N squared = across.squaredNorm(), reach = ri + rj, none = zero<N>();
  SpheresMeet<N> out{spheres_apart(across, ri, rj)};
  const N distance = root(squared), inverse = 1 / distance;
  o.depth = reach - distance;
  o.normal = chosen(distance > 0, V(inverse * across), V(V::UnitX()));
  o.radius = ri * rj / reach;
  // Without cancellation, as of two disks.
  const N lens = ri - o.depth * (2 * rj - o.depth) * (0.5 * inverse);
  const N inside = ri > rj ? distance : none;
  out.lever_i = distance > magnitude(N(ri - rj)) ? lens : inside;
  out.lever_j = out.lever_i - distance;
  return out;
}
template <class N>
[[gnu::always_inline]] inline void set_arms(const N& lever_i, const N& lever_j, Overlap3Of<N>& o) {
  o.arm_i = lever_i * o.normal;
  o.arm_j = lever_j * o.normal;
}

}  // namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS
