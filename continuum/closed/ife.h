// Incipient failure everywhere (Roul 4.1; Sokolovskii's self-similar heap): Mohr and Coulomb's
// limit holds at every point of a heap at its angle of repose, in the active state,
//   sigma_xx = sigma_yy k(u),  u = sigma_xy / sigma_yy,
//   k(u) = (1 + sin^2 phi - 2 sqrt(sin^2 phi - u^2 cos^2 phi)) / cos^2 phi   (compression
//   positive).
// With stress = rho g y s(xi), xi = x / y, y down, equilibrium is
//   s_xx' + s_xy - xi s_xy' = 0,  s_xy' + s_yy - xi s_yy' = 1,
// with s_xy(0) = 0 on the axis and no stress on the slope xi = c = cot(phi). The slope is a slip
// line, so the equations are singular there; written for A = s_yy / (c - xi), W = s_xy / (c - xi)
// they have one smooth solution (the plastic flank of Cantelaube, which also satisfies them, never
// gets s_xy = 0 on the axis). It is found as polynomials in xi by collocation at Chebyshev's points
// and Newton's method. The pressure has a peak on the axis.
#pragma once
#include "continuum/closed/heap_field.h"

namespace grainfield::continuum {

class IfeField : public HeapField {
 public:
  /// `phi` in rad, 15 to 60 degrees. Throws ComputationFailed when Newton's method does not
  /// converge.
  IfeField(double phi, double rho_g);
  /// The polynomials' own derivatives; sigma_xx follows from the yield condition exactly.
  LinearStress gradient(std::size_t region, double x, double y) const override;

 private:
  double cot_;
  Eigen::VectorXd a_, w_;  // Chebyshev coefficients of A and W in 2 xi / c - 1
};

}  // namespace grainfield::continuum
