// Quaternions side by side (lanes.h), operation by operation as space3.h and Eigen have them.
#pragma once
#include "dem/space/lanes3.h"

namespace grainfield::dem {

/// A quaternion of each lane.
template <int W>
struct Turn {
  Lanes<W> w;
  Three<W> v;
};
template <int W>
[[gnu::always_inline]] inline Three<W> turned(const Turn<W>& q, const Three<W>& a) {
  const Three<W> once = cross<W>(q.v, a), twice = once + once;
  return a + scaled<W>(q.w, twice) + cross<W>(q.v, twice);
}
template <int W>
[[gnu::always_inline]] inline Turn<W> back(const Turn<W>& q) {
  return {q.w, -q.v};
}
template <int W>
[[gnu::always_inline]] inline Turn<W> product(const Turn<W>& a, const Turn<W>& b) {
  const Three<W>&p = a.v, &q = b.v;
  return {
      a.w * b.w - p.x * q.x - p.y * q.y - p.z * q.z,
      {a.w * q.x + p.x * b.w + p.y * q.z - p.z * q.y, a.w * q.y + p.y * b.w + p.z * q.x - p.x * q.z,
       a.w * q.z + p.z * b.w + p.x * q.y - p.y * q.x}};
}

/// As rotation_of (rotation.h).
template <int W>
struct Angle {
  Lanes<W> cosine, sine;
};
template <int W>
[[gnu::always_inline]] inline Angle<W> angle_of(const Lanes<W>& angle) {
  using V = Lanes<W>;
  using Bits = typename LanesOf<W>::Bits;
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00;
  constexpr double kHalfPiLow = 6.07710050650619224932e-11;
  constexpr double kRound = 6755399441055744.0;
  const V shifted = angle * kTwoOverPi + kRound, turns = shifted - kRound;
  const V r = (angle - turns * kHalfPiHigh) - turns * kHalfPiLow;
  const V q = r * r, q2 = q * q, q4 = q2 * q2;
  const V ps = (q * (-1.0 / 6) + q2 * (1.0 / 120 + q * (-1.0 / 5040))) +
               q4 * ((1.0 / 362880 + q * (-1.0 / 39916800)) +
                     q2 * (1.0 / 6227020800 + q * (-1.0 / 1307674368000)));
  const V pc = (q * -0.5 + q2 * (1.0 / 24 + q * (-1.0 / 720))) +
               q4 * (((1.0 / 40320 + q * (-1.0 / 3628800)) +
                      q2 * (1.0 / 479001600 + q * (-1.0 / 87178291200))) +
                     q4 * (1.0 / 20922789888000));
  const V s = r + r * ps, c = 1 + pc;
  // The quarter is in the last bits of the rounded sum.
  const Bits quarter =
      reinterpret_cast<Bits>(shifted) & (magnitude(turns) < 1e15 ? Bits{} + 3 : Bits{});
  const auto swapped = (quarter & 1) != 0, negative = (quarter & 2) != 0;
  const V cosine = swapped ? -s : c, sine = swapped ? c : s;
  return {negative ? -cosine : cosine, negative ? -sine : sine};
}

/// As quaternion_of (space3.h) of `size` along an axis.
template <int W>
[[gnu::always_inline]] inline Turn<W> turn_about(int axis, const Lanes<W>& size) {
  using V = Lanes<W>;
  const V full = root_of<W>(size * size);
  const Angle<W> half = angle_of<W>(0.5 * full);
  const auto turns_at_all = full > 0;
  const V share = half.sine / full, none{};
  const V along = turns_at_all ? share * size : none;
  const V beside = turns_at_all ? share * (size * none) : none;
  Turn<W> out{turns_at_all ? half.cosine : none + 1, {beside, beside, beside}};
  (axis == 0 ? out.v.x : axis == 1 ? out.v.y : out.v.z) = along;
  return out;
}
/// As quaternion_of.
template <int W>
[[gnu::always_inline]] inline Turn<W> turn_by(const Three<W>& turn) {
  using V = Lanes<W>;
  const V full = root_of<W>(dot<W>(turn, turn)), none{};
  const Angle<W> half = angle_of<W>(0.5 * full);
  const auto turns_at_all = full > 0;
  return {turns_at_all ? half.cosine : none + 1,
          chosen<W>(turns_at_all, scaled<W>(half.sine / full, turn), Three<W>{none, none, none})};
}

template <int W>
[[gnu::always_inline]] inline Lanes<W> squared(const Turn<W>& q) {
  const Three<W>& v = q.v;
  return (v.x * v.x + v.y * v.y) + (v.z * v.z + q.w * q.w);
}
template <int W>
[[gnu::always_inline]] inline Turn<W> normalized(const Turn<W>& q) {
  const Lanes<W> square = squared<W>(q);
  const Lanes<W> size = square > 0 ? root_of<W>(square) : Lanes<W>{} + 1;
  return {q.w / size, {q.v.x / size, q.v.y / size, q.v.z / size}};
}

}  // namespace grainfield::dem
