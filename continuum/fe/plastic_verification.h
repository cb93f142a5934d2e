// The elasto-plastic solver on problems whose answer is known: for tests and studies.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "continuum/fe/plastic_solver.h"

namespace grainfield::continuum {

/// Worst error of the plastic flank's linear stress, over the largest stress.
struct FlankCheck {
  double stress_error = 0;
  double corner_error = 0;   ///< of the recovered stress
  double plastic_share = 0;  ///< of the points of integration at yield, of 1
  std::vector<fe::LoadStep> steps;
};

/// Cohesionless material under an infinite slope: stress (k, 1 + k t^2, -k t) (y + t x), t the
/// slope's tangent, below y = -t x. `share` says which k: 0 the active one,
/// (cos phi/(1 + sqrt(1 - cos^2 phi/cos^2 slope)))^2, 1 the passive one, both at the limit
/// everywhere (the same where the slope is phi: Cantelaube's flank); between them, elastic. A
/// triangle out of it gets the displacements that belong to this stress plus, at the limit, a
/// uniform plastic flow of `shear` along its border, and its weight. With nu = 0.3 the out-of-plane
/// stress is the middle one for phi of 25 to 55 degrees.
struct InfiniteSlope {
  double phi_deg = 28, slope_deg = 28, dilation_deg = 0;
  double share = 0;
  double shear = 1e-2;
  int cells = 4;
};
FlankCheck check_infinite_slope(const InfiniteSlope& slope);

/// Cantelaube's flank: the slope at the friction angle.
FlankCheck check_plastic_flank(double phi_deg, double dilation_deg, double shear, int cells);

/// Prandtl's bearing capacities of weightless ground under a strip: N_q = exp(pi tan phi)
/// tan^2(45 deg + phi/2) (mean pressure over a surcharge beside the strip, no cohesion) and
/// N_c = (N_q - 1) cot phi, 2 + pi without friction (over the cohesion, no surcharge).
double prandtl_n_q(double phi_deg);
double prandtl_n_c(double phi_deg);

/// Mean pressure under a rigid rough strip pressed into weightless ground until it gives way.
/// `cells`: squares, of four triangles each, under half the strip; outwards they grow with tan phi.
struct Footing {
  double phi_deg = 0, dilation_deg = 0;
  bool surcharge = false;  ///< N_q: no cohesion, a surcharge of 1; else N_c: a cohesion of 1
  int cells = 2;
  double settlement = 0.4;  ///< over half the strip's width, E = 200 times Prandtl's pressure/5
};
struct FootingCheck {
  std::vector<double> settlement;  ///< over half the strip's width, per load step
  std::vector<double> pressure;    ///< mean, over the cohesion or the surcharge
  double capacity = 0;             ///< the last pressure
  double last_rise = 0;            ///< of the pressure in the last tenth of the settlement, of 1
  int unknowns = 0;
  std::vector<fe::LoadStep> steps;
};
FootingCheck check_strip_footing(const Footing& footing);

/// A thick-walled cylinder (radii 1 and 2, no strain along its axis) under the pressure inside that
/// makes it yield out to the radius `yields` (1 or less: elastic, and half of the pressure at which
/// yielding begins). With N = (1 + sin phi)/(1 - sin phi), s = 2 c cos phi/(1 - sin phi) and c = 1,
/// outside of `yields` = e
///   s_rr, s_tt = A (1 -+ 4/r^2),   A = s/(N (1 + 4/e^2) - 1 + 4/e^2),
/// inside, at the limit N s_tt - s_rr = s,
///   s_rr = s/(N - 1) + K r^(1/N - 1); without friction s_rr = s_rr(e) - s log(e/r).
struct Cylinder {
  double phi_deg = 0, dilation_deg = 0;
  double yields = 1.5;
  int cells = 4;  ///< squares of four triangles through the wall
};
struct CylinderCheck {
  double pressure = 0;       ///< over the cohesion
  double stress_error = 0;   ///< 2-norm of the error of rr and tt over that of the stress
  double yielded_error = 0;  ///< of the yielded share of the volume, against the exact one
  std::vector<fe::LoadStep> steps;
};
CylinderCheck check_cylinder(const Cylinder& cylinder);

/// A column in a smooth rigid tube under its own weight: s_zz = -depth, s_rr = s_tt =
/// nu/(1 - nu) s_zz. 2-norm of the error over that of the stress.
double check_column(int cells);

}  // namespace grainfield::continuum
