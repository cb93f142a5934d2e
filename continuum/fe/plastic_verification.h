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

/// Cohesionless material under a slope at its friction angle, at the limit everywhere: stress
/// (sin^2 b, 1 + cos^2 b, sin b cos b) times minus the depth below the slope, b = 90 degrees - phi
/// (Cantelaube's flank). A triangle out of it gets the displacements that belong to this stress
/// plus a uniform plastic flow of `shear` along its border, and its weight. With nu = 0.3 the
/// out-of-plane stress is the middle one for phi of 25 to 55 degrees.
FlankCheck check_plastic_flank(double phi_deg, double dilation_deg, double shear, int cells);

/// Mean pressure over cohesion under a rigid rough strip pressed into weightless ground until it
/// gives way: N_c, (2 + pi) without friction. `cells`: squares, of four triangles each, under half
/// the strip.
struct FootingCheck {
  std::vector<double> settlement;  ///< over half the strip's width, per load step
  std::vector<double> pressure;    ///< mean, over the cohesion
  double capacity = 0;             ///< the last pressure
  double last_rise = 0;            ///< of the pressure in the last tenth of the settlement, of 1
  std::vector<fe::LoadStep> steps;
};
FootingCheck check_strip_footing(double phi_deg, double dilation_deg, int cells, double settlement);

}  // namespace grainfield::continuum
