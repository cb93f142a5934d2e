// Oriented stress linearity (Wittmer, Cates and Claudin 1997; Roul 4.4): a heap whose stresses obey
//   sigma_xx = eta sigma_yy + mu sign(x) sigma_xy     (compression positive, y down).
// Equilibrium then is hyperbolic, with characteristics dx/dy = c1 > 0 and c2 < 0 on the right half,
// c1,2 = (mu +- sqrt(mu^2 + 4 eta)) / 2. With c = cot(phi), S = x / (c y), s* = c / (c^2 - mu c -
// eta) and S0 = c1 / c, stress = rho g y s(S), the field is
//   S >= S0:  (s_xx, s_yy, s_xy) = s* (eta c, c - mu, eta) (1 - S)
//   S <  S0:  (s_xx, s_yy, s_xy) = s* (c - c1)/c1 (eta c1, c1 - mu S, eta S)
// The slope yields, as it must at the angle of repose, when eta = eta0 (1 - mu tan phi),
// eta0 = 1/(1 + 2 tan^2 phi). Members: BCC mu = 0; FPA eta = 1, mu = -2 tan phi.
#pragma once
#include "continuum/closed/heap_field.h"

namespace grainfield::continuum {

/// The closure's constants and the slopes of its characteristics.
struct Closure {
  double eta = 0, mu = 0;
  double c1() const;  ///< dx/dy, y down; above 0 for eta > 0
  double c2() const;  ///< below 0 for eta > 0
};

/// The same closure as a ratio of normal stresses on two fixed orthogonal directions,
/// sigma_nn = K sigma_mm, tau the angle of the direction n as Roul 4.23 counts it.
struct StressRatio {
  double K = 1, tau = 0;  ///< -, rad
};

/// eta0 (1 - mu tan phi), what makes the slope yield (Roul 4.24); its inverse for mu.
double eta_at_yield(double phi, double mu);
double mu_at_yield(double phi, double eta);
/// K, tau to eta, mu (Roul 4.23): eta = (K - T^2)/(1 - K T^2), mu = 2 (K + 1) T/(1 - K T^2),
/// T = tan(tau).
Closure closure_of(const StressRatio& ratio);
/// eta, mu to K, tau for eta > -mu^2/4, from the axes of the closure's quadratic form. Of the two
/// descriptions, (K, tau) and (1/K, tau - pi/2), the one with tau in (pi/4, 3 pi/4): K >= 1 for
/// eta <= 1.
StressRatio ratio_of(const Closure& closure);
/// sigma_xx - eta sigma_yy - mu sign(x) sigma_xy of a stress in the project's axes (y up, tension
/// positive), at x.
double closure_residual(const Closure& closure, const Eigen::Vector3d& stress, double x);

/// Parameters of a heap whose closure can be chosen: phi_deg, rho_g, eta, mu, K, tau_deg; and what
/// they choose. Throws BadParameter naming the model for a choice that is none, without a
/// characteristic inside the heap, or outside the hyperbolic range.
std::vector<Parameter> closure_parameters();
Closure chosen_closure(const std::string& model, const Settings& s, double phi);

/// The heap of slope and friction angle phi (rad). Needs eta > 0 and c1 < cot(phi). Regions: left
/// outer, left inner, right inner, right outer.
SectorField osl_field(double phi, const Closure& closure, double rho_g);

}  // namespace grainfield::continuum
