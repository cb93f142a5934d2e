// Elementary functions whose bits are the same on every machine, beside sine and cosine of
// rotation.h: sums, products, quotients and roots alone, which IEEE 754 fixes.
#pragma once
#include <cmath>
#include <numbers>

#include "dem/space/rotation.h"

namespace grainfield::dem {

/// asin x, rad, for 0 <= x <= 1, within two units of its last digit; nan for nan.
inline double arc_sine(double x) {
  // Beyond a half from the half angle: asin x = pi/2 - 2 asin sqrt((1 - x)/2).
  const bool near_one = x > 0.5;
  const double y = near_one ? std::sqrt(0.5 * (1 - x)) : x, q = y * y;
  // The series' first terms are within 6e-5; what is missing has the sine
  // sin(asin y - guess) = y cos guess - cos(asin y) sin guess.
  const double guess = y * (1 + q * (1.0 / 6 + q * (3.0 / 40 + q * (15.0 / 336))));
  const auto [c, s] = rotation_of(guess);
  const double rest = y * c - std::sqrt(1 - q) * s;
  const double angle = guess + (rest + rest * rest * rest / 6);
  return near_one ? 0.5 * std::numbers::pi - 2 * angle : angle;
}

/// Angle of (x, y), y >= 0, from the first axis: in [0, pi], rad, within two units of its
/// last digit. 0 for (0, 0).
inline double arc_of(double y, double x) {
  const double size = std::sqrt(x * x + y * y);
  if (!(size > 0)) return size;  // nan stays
  if (std::fabs(x) < y) {
    const double beside = arc_sine(std::fabs(x) / size);
    return 0.5 * std::numbers::pi + (x < 0 ? beside : -beside);
  }
  const double above = arc_sine(y / size);
  return x < 0 ? std::numbers::pi - above : above;
}

/// Cube root of x >= 0, within two units of its last digit.
inline double cube_root(double x) {
  if (!(x > 0)) return x;  // nan stays
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // in [1/2, 1)
  const int third = exponent >= 0 ? exponent / 3 : -((2 - exponent) / 3);
  m = std::ldexp(m, exponent - 3 * third);  // in [1/2, 4)
  // Within 4 % by a line, then three of Halley's steps: 7e-5, 3e-13, round-off.
  double y = 0.66 + 0.25 * m;
  for (int k = 0; k < 3; ++k) {
    const double cube = y * y * y;
    y *= (cube + 2 * m) / (2 * cube + m);
  }
  return std::ldexp(y, third);
}

/// ln x for positive normal x, within 2e-16 of it (absolute below 1).
inline double natural_log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // in [1/2, 1)
  if (m < 0.5 * std::numbers::sqrt2) {
    m *= 2;
    --exponent;
  }
  // ln m = 2 artanh z, |z| < 0.172: the first term left out is below 2e-18 of the sum.
  const double z = (m - 1) / (m + 1), q = z * z;
  double sum = 0;
  for (int k = 11; k >= 0; --k) sum = sum * q + 1.0 / (2 * k + 1);
  return 2 * z * sum + exponent * std::numbers::ln2;
}

}  // namespace grainfield::dem
