// The contact ellipse of two paraboloids (Hertz; Wellmann eqs. 9-18, 21 and 22; Johnson 1985,
// chapter 4): its semi-axes' ratio, its force and its compliances, from the relative curvatures
// A <= B.
//
// With e^2 = 1 - 1/k^2, k = a/b >= 1 the ratio of the semi-axes, K and E the complete elliptic
// integrals and
//
//   B(e) = (E - (1 - e^2) K)/e^2,  D(e) = (K - E)/e^2,  B + D = K
//
// Wellmann's eq. 11 (with k^2 for his 1/k^2: physics section 8) reads B/A = k^2 B(e)/D(e), without
// a difference of nearly equal numbers. k by Newton's method on logarithms, where both sides are
// nearly straight; K and D by the arithmetic-geometric mean. Sums, products, quotients and roots
// alone: the same bits on every machine.
#pragma once
#include <cmath>
#include <numbers>

#include "dem/space/elementary.h"

namespace grainfield::dem {

/// K(e), B(e), D(e) of Wellmann's eqs. 16 and 17, for 0 < complement <= 1, complement^2 = 1 - e^2;
/// to 1e-15 of them.
struct EllipticIntegrals {
  double k = 0, b = 0, d = 0;
};
inline EllipticIntegrals elliptic_integrals(double complement) {
  // Gauss: K - E = K sum 2^(n-1) c_n^2, c_0 = e, c_{n+1} = c_n^2/(4 a_{n+1}); shares are c_n^2/e^2.
  double a = 0.5 * (1 + complement), g = std::sqrt(complement);
  double square = 0.25 * (1 - complement) * (1 - complement);  // c_1^2
  double share = 0.25 * (1 - complement) / (1 + complement), sum = 0.5 + share, weight = 1;
  while (square > 1e-17 * a * a) {
    const double next = 0.5 * (a + g), shrink = square / (16 * next * next);
    g = std::sqrt(a * g);
    a = next;
    share *= shrink;
    square *= shrink;
    weight *= 2;
    sum += weight * share;
  }
  EllipticIntegrals out;
  out.k = 0.5 * std::numbers::pi / a;
  out.d = out.k * sum;
  out.b = out.k - out.d;
  return out;
}

/// The ratio a/b of the semi-axes for B/A = ratio >= 1, to 1e-12 of it, and the integrals there.
struct EllipseRatio {
  double kappa = 1;
  EllipticIntegrals integrals;
};
inline EllipseRatio ellipse_ratio(double ratio) {
  const double target = ratio > 1 ? natural_log(ratio) : 0;
  // Within 2 % for ratios up to 1e10.
  double x = target * (0.5 + 1 / (6 + 0.45 * target));
  EllipseRatio out;
  for (int n = 0; n < 12; ++n) {
    const double complement = exponential(-x), q = complement * complement, m = 1 - q;
    const EllipticIntegrals e = elliptic_integrals(complement);
    const double rate = m > 1e-3 ? (e.b - q * e.d) / m : 0.1875 * std::numbers::pi;  // dD/dx
    const double slope = 3 - rate / e.b - rate / e.d;
    const double step = (target - 2 * x - natural_log(e.b / e.d)) / slope;
    out = {1 / complement, e};
    x += step;
    if (std::fabs(step) < 1e-13 * (1 + x)) break;
  }
  return out;
}

/// What a contact of these relative curvatures (1/m) is like at a depth d: the force is
/// gamma E* d^(3/2), the greater semi-axis axis sqrt(d).
struct EllipticContact {
  double gamma = 0;  ///< sqrt(m); eq. 13; 4/3 sqrt(R) of spheres
  double axis = 0;   ///< sqrt(m); eq. 18
  EllipseRatio shape;
};
inline EllipticContact contact_of(double lesser, double greater, const EllipseRatio& shape) {
  EllipticContact out;
  out.shape = shape;
  const auto& [kappa, integrals] = shape;
  const double k = integrals.k, e = k - (1 - 1 / (kappa * kappa)) * integrals.d;
  out.gamma = 2.0 / 3 * std::numbers::pi * kappa * std::sqrt(e / (k * k * k * (lesser + greater)));
  out.axis = std::sqrt(integrals.d / (lesser * k));
  return out;
}
inline EllipticContact elliptic_contact(double lesser, double greater) {
  return contact_of(lesser, greater, ellipse_ratio(greater / lesser));
}

}  // namespace grainfield::dem
