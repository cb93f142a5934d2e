// Sine and cosine of a rotation angle, in line.
//
// The C library chooses its code by the processor (with or without fused multiply-add), so that its
// last bits differ between machines; these are the same everywhere, and faster because they are
// inlined and need no special cases. Argument reduction by pi/2 in two parts (Cody and Waite 1980),
// then the Taylor series, whose first term left out is below 5e-17 for |r| <= pi/4.
#pragma once
#include <cmath>

namespace grainfield::dem {

struct Rotation {
  double cosine = 1, sine = 0;
};

/// Within 2e-16 for |angle| up to 1e5 rad; nan for nan.
inline Rotation rotation_of(double angle) {
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00;  // 33 bits of pi/2
  constexpr double kHalfPiLow = 6.07710050650619224932e-11;
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to a whole number
  const double turns = (angle * kTwoOverPi + kRound) - kRound;
  const double r = (angle - turns * kHalfPiHigh) - turns * kHalfPiLow;
  // Estrin's scheme (short chains of dependent operations), the small terms first.
  const double q = r * r, q2 = q * q, q4 = q2 * q2;
  const double ps = (q * (-1.0 / 6) + q2 * (1.0 / 120 + q * (-1.0 / 5040))) +
                    q4 * ((1.0 / 362880 + q * (-1.0 / 39916800)) +
                          q2 * (1.0 / 6227020800 + q * (-1.0 / 1307674368000)));
  const double pc = (q * -0.5 + q2 * (1.0 / 24 + q * (-1.0 / 720))) +
                    q4 * (((1.0 / 40320 + q * (-1.0 / 3628800)) +
                           q2 * (1.0 / 479001600 + q * (-1.0 / 87178291200))) +
                          q4 * (1.0 / 20922789888000));
  const double s = r + r * ps, c = 1 + pc;
  switch (static_cast<long long>(std::fabs(turns) < 1e15 ? turns : 0) & 3) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

}  // namespace grainfield::dem
