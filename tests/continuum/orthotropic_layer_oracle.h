// A Fourier integral of the orthotropic layer, beside the finite elements.
#pragma once
#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "continuum/closed/orthotropic.h"

namespace grainfield::continuum::testing {

/// On the base of a layer of depth 1 under F = 1, at x.
struct OnBase {
  double pressure, shear;
  /// Second derivative of the pressure along the base.
  double curvature;
};

/// Airy's function is (1/pi) Int g(k d) cos(k x) / k^2 dk with g'''' - 2 r g'' + t g = 0: g(0) = 1,
/// g'(0) = 0; base: g''' - (2 r + nu) g' = 0 (no vertical displacement) and g' = 0 (smooth) or g''
/// + nu g = 0 (rough). Not for r^2 = t.
inline OnBase exact_base(const Orthotropy& o, double nu, bool rough, double x) {
  using C = std::complex<double>;
  const C root = std::sqrt(C(o.r * o.r - o.t));
  const C exponents[] = {std::sqrt(C(o.r) + root), std::sqrt(C(o.r) - root)};
  const double decay = std::min(exponents[0].real(), exponents[1].real());
  const int n = 800;
  const double end = 30 / decay, step = end / n;
  OnBase sum{0, 0, 0};
  for (int i = 0; i < n; ++i) {
    const double u = (i + 0.5) * step;
    Eigen::Matrix4cd m;
    Eigen::RowVector4cd g, g1;
    for (int k = 0; k < 4; ++k) {
      // exp(-l s) and exp(l (s - u)).
      const C l = k < 2 ? -exponents[k] : exponents[k - 2];
      const C top = k < 2 ? C(1) : std::exp(-l * u), base = k < 2 ? std::exp(l * u) : C(1);
      m(0, k) = top;
      m(1, k) = l * top;
      m(2, k) = (l * l * l - (2 * o.r + nu) * l) * base;
      m(3, k) = (rough ? l * l + nu : l) * base;
      g(k) = base;
      g1(k) = l * base;
    }
    const Eigen::Vector4cd a = m.fullPivLu().solve(Eigen::Vector4cd(1, 0, 0, 0));
    const double value = (g * a).value().real() * std::cos(u * x) * step / M_PI;
    sum.pressure += value;
    sum.curvature -= u * u * value;
    sum.shear += (g1 * a).value().real() * std::sin(u * x) * step / M_PI;
  }
  return sum;
}

}  // namespace grainfield::continuum::testing
