// Elementary functions whose bits are the same on every machine, beside sine and cosine of
// rotation.h: sums, products, quotients and roots alone, which IEEE 754 fixes.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
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
  const auto bits = std::bit_cast<std::uint64_t>(x);
  int exponent = static_cast<int>(bits >> 52 & 0x7FF) - 1022;
  double m = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFF) | 0x3FE0000000000000);  // in [1/2, 1)
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

/// e^x, within two units of its last digit; 0 below -708, infinite above 709; nan for nan.
inline double exponential(double x) {
  if (!(x > -708)) return x <= -708 ? 0 : x;
  if (x > 709) return std::numeric_limits<double>::infinity();
  constexpr double kLn2High = 6.93147180369123816490e-01;  // 33 bits of ln 2
  constexpr double kLn2Low = 1.90821492927058770002e-10;
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to a whole number
  const double turns = (x * std::numbers::log2e + kRound) - kRound;
  const double r = (x - turns * kLn2High) - turns * kLn2Low;
  // |r| <= 0.3466: the series' first term left out is below 5e-18.
  const double q = r * r, q2 = q * q, q4 = q2 * q2;
  const double low = (1 + r) + q * (0.5 + r * (1.0 / 6)) +
                     q2 * ((1.0 / 24 + r * (1.0 / 120)) + q * (1.0 / 720 + r * (1.0 / 5040)));
  const double high = (1.0 / 40320 + r * (1.0 / 362880)) +
                      q * (1.0 / 3628800 + r * (1.0 / 39916800)) +
                      q2 * (1.0 / 479001600 + r * (1.0 / 6227020800));
  const auto power = static_cast<std::uint64_t>(static_cast<std::int64_t>(turns) + 1023);
  return (low + q4 * high) * std::bit_cast<double>(power << 52);
}

/// ln of the gamma function for x > 0, within 1e-15 of it (absolute below 1).
inline double log_gamma(double x) {
  double product = 1;
  for (; x < 12; ++x) product *= x;
  // Stirling's series; its first term left out is below 1e-17.
  const double i = 1 / x, q = i * i;
  const double series =
      i * (1.0 / 12 +
           q * (-1.0 / 360 +
                q * (1.0 / 1260 +
                     q * (-1.0 / 1680 + q * (1.0 / 1188 + q * (-691.0 / 360360 + q / 156))))));
  constexpr double kHalfLogTwoPi = 0.91893853320467274178;
  return (x - 0.5) * natural_log(x) - x + kHalfLogTwoPi + series - natural_log(product);
}

/// Beta function of x, y > 0, to 1e-14 of it.
inline double beta(double x, double y) {
  return exponential(log_gamma(x) + log_gamma(y) - log_gamma(x + y));
}

}  // namespace grainfield::dem
