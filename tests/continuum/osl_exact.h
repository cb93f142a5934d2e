// Exact solutions of oriented stress linearity with constant eta > 0, mu, to test the field solvers
// with. Compression positive, y down.
#pragma once
#include <cmath>
#include <functional>

#include "continuum/osl/problem.h"

namespace grainfield::continuum::osl::exact {

struct Constants {
  double eta = 0.744, mu = -0.31;
  double root() const { return std::sqrt(mu * mu + 4 * eta); }
  double c1() const { return (mu + root()) / 2; }
  double c2() const { return (mu - root()) / 2; }
};

/// physics.md section 4, the closed form of a heap, rho g = 1, c = cot(phi).
inline State closed_form(const Constants& k, double c, double x, double y) {
  const double S = std::abs(x) / (c * y), sign = x < 0 ? -1 : 1;
  const double star = c / (c * c - k.mu * c - k.eta), c1 = k.c1();
  if (S >= c1 / c) return star * y * (1 - S) * State(c - k.mu, sign * k.eta);
  return star * y * (c - c1) / c1 * State(c1 - k.mu * S, sign * k.eta * S);
}

/// A heap whose weight b(y) depends on the depth, B its integral from 0. (B(y), 0) satisfies the
/// equations; waves (1, c1) f1(x - c1 y) + (1, c2) f2(x - c2 y) make the stress vanish on the slope
/// x = c y, and inside x < c1 y, where f1 comes from the axis, make sxy vanish there.
inline State heap(const Constants& k, double c, const std::function<double(double)>& B, double x,
                  double y) {
  const double X = std::abs(x), sign = x < 0 ? -1 : 1, c1 = k.c1(), c2 = k.c2();
  const double f2 = -c1 / (c1 - c2) * B((X - c2 * y) / (c - c2));
  const double outer = X - c1 * y;
  const double f1 =
      c2 / (c1 - c2) * (outer >= 0 ? B(outer / (c - c1)) : B(c2 / c1 * outer / (c - c2)));
  return {B(y) + f1 + f2, sign * (c1 * f1 + c2 * f2)};
}

/// The weightless half plane under the pressure p(x), even in x.
inline State pulse(const Constants& k, const std::function<double(double)>& p, double x, double y) {
  const double X = std::abs(x), sign = x < 0 ? -1 : 1, c1 = k.c1(), c2 = k.c2();
  const double f2 = c1 / (c1 - c2) * p(X - c2 * y), ahead = X - c1 * y;
  const double f1 = -c2 / (c1 - c2) * (ahead >= 0 ? p(ahead) : p(c2 / c1 * ahead));
  return {f1 + f2, sign * (c1 * f1 + c2 * f2)};
}

}  // namespace grainfield::continuum::osl::exact
