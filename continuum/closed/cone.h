// Oriented stress linearity in a cone (Wittmer, Cates and Claudin 1997). Compression positive,
// z down from the apex, axisymmetric, no displacement round the axis:
//   d_r s_rr + d_z s_rz + (s_rr - s_tt)/r = 0,  d_r s_rz + d_z s_zz + s_rz/r = rho g
// with the closures s_rr = eta s_zz + mu s_rz and s_tt = s_rr. The cone has no size, so stress =
// rho g z s(S), S = r tan(phi)/z, and with c = tan(phi), p = s_zz, q = s_rz
//   c (eta p' + mu q') + q - S q' = 0,  c q' + p - S p' + c q/S = 1,
// p = q = 0 on the surface S = 1. The equations are singular at S0 = c c1, where the characteristic
// from the apex runs (osl.h). From the surface to it they have one solution, smooth in sqrt(S -
// S0), in which it is integrated. From the axis, q = 0, they have one for every p(0),
//   q = a S, p = p(0) - a mu/eta S, a = (1 - p(0))/(2 c),
// and p is continuous at S0 for one of these.
#pragma once
#include <array>
#include <vector>

#include "continuum/closed/osl.h"

namespace grainfield::continuum {

class OslCone {
 public:
  /// phi in rad; needs eta > 0 and c1 < cot(phi).
  OslCone(double phi, const Closure& closure, double rho_g);

  /// s_rr = s_tt, s_zz, s_rz over rho g z at S, 0 <= S <= 1.
  std::array<double, 3> reduced(double S) const;
  /// xx, yy, zz, yz, xz, xy in the project's axes (apex at the origin, z up, tension positive), Pa;
  /// nan outside of the cone.
  std::array<double, 6> stress(double x, double y, double z) const;

  double singular() const { return singular_; }  ///< S0
  const Closure& closure() const { return closure_; }

 private:
  std::array<double, 2> derivative(double S, const std::array<double, 2>& y) const;
  void integrate();
  std::array<double, 2> outer(double S) const;

  double tangent_, rho_g_, singular_;
  Closure closure_;
  double centre_ = 0;  // p(0)
  // p, q and their derivatives by t, S = S0 + (1 - S0) t^2, evenly from t = 1 down.
  std::vector<std::array<double, 2>> value_, slope_;
};

/// Fixed principal axes (s_rr = s_zz - 2 c s_rz) with Lévy's assumption s_tt = (s_rr + s_zz)/2 as
/// second closure (Pipatpongsa and Siriteerakul 2010). The solution in closed form is ours. The
/// equations become
///   c p' - (2 c^2 + S) q' + q - c^2 q/S = 0,  c q' + p - S p' + c q/S = 1.
/// They are solved by (1, 0), the other field by (1 - 3/2 S, -S/(2c)) and, since the Wronskian is
/// D^(3/2)/S with D = S^2 + 2 c^2 S - c^2, by reduction of order. From the surface to S0, D = 0,
///   p = 1 - cos^3(phi) (D^(3/2)/S^2 + 2 c^2 (1 - 3/2 S) I),  q = cos^3(phi) c S I,
///   I = integral of sqrt(D)/s^3 from S to 1 = (1 + c^2)/(2c) (u + sin u cos u),
///   sin u = sin(phi) (1/S - 1),
/// and from S0 to the axis p = 1 - pi/2 sin(phi) (1 - 3/2 S), q = pi/4 cos(phi) S.
class LevyCone {
 public:
  /// phi in rad, above 0 and below pi/2.
  LevyCone(double phi, double rho_g);

  /// s_rr, s_zz, s_rz over rho g z at S, 0 <= S <= 1; s_tt is the mean of the first two.
  std::array<double, 3> reduced(double S) const;
  /// The stress at a point, as OslCone::stress() gives it.
  std::array<double, 6> stress(double x, double y, double z) const;

  double singular() const { return singular_; }  ///< S0
  const Closure& closure() const { return closure_; }

 private:
  double phi_, tangent_, rho_g_;
  Closure closure_;
  double singular_;
};

}  // namespace grainfield::continuum
