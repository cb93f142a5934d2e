// What a ball feels of a wall: half spaces at the nearest points.
#pragma once
#include <algorithm>
#include <cmath>

#include "dem/space/plane.h"

namespace grainfield::dem {

// At most so many contacts of one grain with one wall; a corner of a box has three.
inline constexpr int kMostPatches = 6;

template <int D>
struct Patch {
  Plane<D> plane;  ///< through the nearest point of the wall; its normal points to the grain
  /// 1/m; of the more curved direction, the other one is straight: above 0 the wall bulges towards
  /// the grain, below 0 it lies around it.
  double curvature = 0;
};

// A wall that lies around a grain as closely as 1 - kLeastGap of its radius feels like that.
inline constexpr double kLeastGap = 0.1;

/// Radius of the ball that, on a plane, has the Hertz stiffness which a ball of this radius has on
/// a cylindrical wall, m. Hertz' elliptic contact with the relative curvatures 2A = 1/r + k and
/// 2B = 1/r (physics, section 5): F = (4/3) E* sqrt(R) d^{3/2} with
///   R (A + B) = (pi^2/4) kappa^2 E(e)/K(e)^3 = (1 - y)^(-p), y = ((B - A)/(B + A))^2,
/// p fitted to the elliptic integrals: within 1e-3 while the wall's radius is above 1.1 r.
inline double effective_radius(double radius, double curvature) {
  if (curvature == 0) return radius;
  const double round = 1 / radius, across = std::max(round + curvature, kLeastGap * round);
  const double sum = 0.5 * (round + across), ratio = (round - across) / (round + across);
  const double y = ratio * ratio;
  return std::pow(1 - y, -(2.0 / 3 + y * (0.0192 + y * (0.006 + y * 0.0135)))) / sum;
}

}  // namespace grainfield::dem
