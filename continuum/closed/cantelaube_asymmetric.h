// Heaps with two slopes at most as steep as the friction angle: plastic flanks, elastic core.
//
// A flank below a slope of angle alpha carries the linear field that vanishes on the slope. With
// zeta the depth straight below the slope, T = tan alpha and rho g = 1 (right flank, y up),
//   (xx, yy, xy) = -zeta (k, 1 + T^2 k, -T k)
// is in equilibrium for every k. Mohr and Coulomb's limit is quadratic in k; with
// q = cos^2 phi / cos^2 alpha its roots are
//   k = (cos phi / (1 + sqrt(1 - q)))^2 (active), (cos phi / (1 - sqrt(1 - q)))^2 (passive),
// one and the same at alpha = phi.
//
// The difference of two linear fields that are both in equilibrium has an Airy function that is a
// binary cubic; they agree on a ray with normal n where that cubic is kappa (n.x)^3 / 6, and then
// only the pressure along the ray has a kink, of slope kappa. So the rays of the core are those
// two for which
//   right flank - left flank - (kinks given inside) = kappa_1 (n_1.x)^3 + kappa_2 (n_2.x)^3 :
// Sylvester's canonical form of a cubic, whose rays are the roots of a quadratic. One linear core
// is the case without a given kink. A core that yields on an inner ray has a kink there whose kappa
// follows from the yield condition on that ray (one equation, solved by bracketing).
#pragma once
#include <optional>
#include <utility>

#include "continuum/closed/cantelaube.h"
#include "continuum/closed/heap_field.h"

namespace grainfield::continuum {

/// Angles in rad; slopes above 0 and at most phi.
struct AsymmetricHeap {
  double phi = 0, left = 0, right = 0;
  bool left_active = true, right_active = true;  ///< root of the flank's quadratic
};

/// Coefficient k of the plastic flank above, for a slope above 0 and at most phi (rad).
double flank_coefficient(double phi, double alpha, bool active);
/// The flank on the right (x > 0) for rho g = 1. The left one is its mirror image.
LinearStress flank_stress(double phi, double alpha, bool active);
/// The same for any coefficient k above 0, at yield or not.
LinearStress flank_stress(double alpha, double k);

/// Flanks of any coefficients between slopes (rad), and a core with a kink of slope `kink` (rho g;
/// below 0 a dip) of the pressure along the ray of angle `ray` (rad from the downward vertical);
/// kink 0: one linear core, whatever the ray. In equilibrium and continuous, whether or not
/// anything yields. Regions as yielding_field; `phi` is noted only. Empty where no such core fits
/// between the flanks and about the ray.
struct KinkedCore {
  double left = 0, right = 0;      ///< slopes
  double k_left = 0, k_right = 0;  ///< coefficients of the flanks
  double ray = 0, kink = 0;
};
std::optional<SectorField> kinked_field(const KinkedCore& heap, double rho_g, double phi);

/// Branches minus and plus: a core that yields on the ray of angle `yield_ray` from the downward
/// vertical (rad, positive to the right), where the pressure along it has a dip or a peak; regions:
/// left flank, left core, right core, right flank. Empty where there is none: a dip exists for rays
/// about the direction in which the flanks' pushes balance only.
std::optional<SectorField> yielding_field(const AsymmetricHeap& heap, CoreBranch branch,
                                          double yield_ray, double rho_g);
/// The least and the largest yield ray of such cores, rad; empty where there is none.
std::optional<std::pair<double, double>> yield_rays(const AsymmetricHeap& heap, CoreBranch branch);
/// Branch zero: one linear core; regions: left flank, core, right flank. Branches minus and plus:
/// yielding_field. Throws BadParameter where no such core fits between the flanks, with the yield
/// rays that do.
SectorField asymmetric_field(const AsymmetricHeap& heap, CoreBranch branch, double yield_ray,
                             double rho_g);

}  // namespace grainfield::continuum
