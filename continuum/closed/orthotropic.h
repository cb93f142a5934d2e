// Line load on a half plane whose elastic axes are the vertical and the horizontal (Lekhnitskii;
// Otto, Bouchaud, Claudin and Socolar 2003).
//
// With Hooke's law eps_xx = sigma_xx/E_x - nu sigma_yy/E_x, eps_yy = sigma_yy/E_y - nu
// sigma_xx/E_x, 2 eps_xy = sigma_xy/G (E_x, E_y, nu = nu_xy, G of the plane: for plane strain those
// of its reduced compliances) Airy's function obeys
//   U_yyyy + 2 r U_xxyy + t U_xxxx = 0,  t = E_x/E_y,  r = (E_x/G - 2 nu)/2,
// elastic for t > 0, r > -sqrt(t); isotropic for r = t = 1. Stress depends on r and t alone: a
// compression along the rays from the load,
//   (xx, yy, xy) = -(F/pi) sqrt(2 t (r + sqrt t)) y (x^2, y^2, x y) / (x^4 + 2 r x^2 y^2 + t y^4)
// with y down. On a horizontal line the pressure has one peak for r >= 0 and two, at
// x = +-y sqrt(-r), for r < 0; for r -> -sqrt(t) they sharpen into the two characteristics
// x = +-t^(1/4) y of a hyperbolic (OSL) material with eta = sqrt(t).
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>

#include "continuum/model.h"

namespace grainfield::continuum {

/// Elastic constants of the plane, Pa (2D: N/m); plane strain: of the reduced compliances.
struct PlaneModuli {
  double E_x = 1, E_y = 1, nu_xy = 0, G = 0.5;
};
/// Those of an isotropic material of Young's modulus E and Poisson's ratio nu in plane strain.
PlaneModuli plane_strain_moduli(double E, double nu);
/// Strains xx, yy, 2 xy of a stress xx, yy, xy; symmetric.
Eigen::Matrix3d compliance(const PlaneModuli& moduli);
/// The inverse of compliance(): positive definite for E_x, E_y, G > 0 and nu_xy^2 < E_x/E_y.
Eigen::Matrix3d stiffness(const PlaneModuli& moduli);
/// Whether the moduli are of a stable material, see stiffness().
bool is_stable(const PlaneModuli& moduli);

/// Ratios of elastic constants that the stress depends on.
struct Orthotropy {
  double r = 1, t = 1;
};
/// From the plane's constants.
inline Orthotropy orthotropy(double E_x, double E_y, double nu_xy, double G) {
  return {(E_x / G - 2 * nu_xy) / 2, E_x / E_y};
}

inline Orthotropy orthotropy(const PlaneModuli& m) {
  return orthotropy(m.E_x, m.E_y, m.nu_xy, m.G);
}

/// That of a model's settings: r and t, or E_x, E_y, G (all three) with nu_xy. Throws BadParameter
/// naming the model when there are some of the three only.
Orthotropy orthotropy(const std::string& model, const Settings& settings);

/// Why r or t has no effect beside moduli (ModelInfo::without_effect).
std::string ratios_beside_moduli(const std::string& parameter, const Settings& complete);

/// Displacement x, y at x, y (y <= 0, not both 0) of the half plane under the line load F, for
/// stable moduli. Like Flamant's it grows with the logarithm of distance; the point at unit
/// distance below the load stays at rest. The strain is e(theta)/r, so that u = c log r + g(theta),
/// with c vertical and g the integral of known functions of the angle, done numerically (to 1e-11
/// of g).
std::array<double, 2> orthotropic_displacement(double F, const PlaneModuli& moduli, double x,
                                               double y);

/// Stress xx, yy, xy at x, y (y up, y < 0), N/m, tension positive; T may be complex. Needs t > 0,
/// r > -sqrt(t).
template <typename T>
std::array<T, 3> orthotropic_stress(double F, const Orthotropy& o, const T& x, const T& y) {
  const T x2 = x * x, y2 = y * y;
  const double root = std::sqrt(o.t);
  const double strength = F / M_PI * std::sqrt(2 * o.t * (o.r + root));
  // x^4 + 2 r x^2 y^2 + t y^4 without the cancellation near r = -sqrt(t).
  const T edge = x2 - root * y2;
  const T scale = strength * y / (edge * edge + 2 * (o.r + root) * x2 * y2);
  return {scale * x2, scale * y2, scale * x * y};
}

}  // namespace grainfield::continuum
