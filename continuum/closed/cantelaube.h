// Elastic core between plastic flanks (Cantelaube and Goddard 1997; Roul 4.3), symmetric heaps.
//
// Heap at its angle of repose phi, beta = pi/2 - phi, core of half tip angle beta_hat from the
// vertical, t = tan(beta_hat). With y down, rho g = 1, tension positive:
//   flank  (xx, yy, xy) = (sin^2 b, 1 + cos^2 b, +-sin b cos b) (|x|/tan b - y)
//   core   xx = (a2 - 1) y,  yy = (a1 - 1) y + b1 |x|,  xy = -a1 x
//   a1 = -sin b cos b (cot b - 1/t)
//   b1 = cot b + (cos^2 b + sin b cos b / t)(cot b - 1/t)
//   a2 = 1 + sin^2 b (t / tan b - 1)
// Both obey equilibrium; the flank lies on Mohr and Coulomb's limit; they agree on the core's
// boundary for every t. What fixes t (Roul, below 4.12) names the branch:
//   zero   b1 = 0, no kink at the axis:       t = sin b / sqrt(1 + cos^2 b), a plateau
//   minus  the axis yields, sigma_xx largest; b1 < 0, a dip:
//          t = sin b / (1 - cos b)^2 (sqrt(1 + (1 - cos b)^2) - 1)
//   plus   the axis yields, sigma_yy largest; b1 > 0, a peak:
//          t = sin b / (1 + cos b)^2 (sqrt(1 + (1 + cos b)^2) + 1)
// (Roul 4.9 prints the flank's two coefficients in exchanged places: docs/theory-wedge.md.)
#pragma once
#include "continuum/closed/heap_field.h"

namespace grainfield::continuum {

enum class CoreBranch { minus, zero, plus };

/// The core's half tip angle of a branch, rad, for a friction angle in rad above 0 and below pi/2.
double core_angle(double phi, CoreBranch branch);

/// a1, a2, b1 of the core for rho g = 1.
struct CoreConstants {
  double a1 = 0, a2 = 0, b1 = 0;
};
/// For angles in rad; beta_hat above 0 and at most pi/2 - phi.
CoreConstants core_constants(double phi, double beta_hat);

/// The heap's field, any beta_hat above 0 and below pi/2 - phi (rad). Regions: left flank, left
/// core, right core, right flank.
SectorField cantelaube_field(double phi, double beta_hat, double rho_g);

}  // namespace grainfield::continuum
