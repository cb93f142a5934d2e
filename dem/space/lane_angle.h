// Sines and cosines side by side (lanes.h), operation by operation as rotation.h has them.
#pragma once
#include "dem/space/lanes.h"

namespace grainfield::dem {

/// As rotation_of (rotation.h).
template <int W>
struct Angle {
  Lanes<W> cosine, sine;
};
/// Below it the terms from the fourth power of the square on are less than a sixteenth of a unit
/// of the last digit of those before: the sums round to the same bits without them.
inline constexpr double kSmallAngle = 0.004;

template <int W>
[[gnu::always_inline]] inline Angle<W> angle_of(const Lanes<W>& angle) {
  using V = Lanes<W>;
  if (!any_of(~(magnitude(angle) < kSmallAngle))) {
    const V q = angle * angle, q2 = q * q;
    const V ps = q * (-1.0 / 6) + q2 * (1.0 / 120 + q * (-1.0 / 5040));
    const V pc = q * -0.5 + q2 * (1.0 / 24 + q * (-1.0 / 720));
    return {1 + pc, angle + angle * ps};
  }
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

}  // namespace grainfield::dem
