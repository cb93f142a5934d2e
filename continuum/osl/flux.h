// Upwind fluxes of the oriented-stress-linearity system through a line element with normal n =
// (nx, ny), y down: (A nx + ny) u, split along the characteristics. Every flux is linear in the
// states: own * (state on the side the normal points away from) + other * (state beyond).
#pragma once
#include "continuum/osl/problem.h"

namespace grainfield::continuum::osl {

/// Slopes dx/dy of the two characteristics, y down, and their closure.
struct Characteristics {
  double eta = 0, mu = 0;           ///< mu with its sign on this side
  double downwind = 0, upwind = 0;  ///< the larger and the smaller root of l^2 - mu l - eta = 0
  Matrix matrix() const;            ///< A
  double sxx(const State& u) const { return eta * u[0] + mu * u[1]; }
};

/// On the side of x with this sign (+1, -1). Throws BadParameter with the place where mu^2 + 4 eta
/// <= 0 or, in a mirrored problem, where eta <= 0: both characteristics would lie on one side of
/// the vertical, so that the axis receives too many or too few of them.
Characteristics characteristics(const Problem& problem, double x, double depth, int sign);

struct Flux {
  Matrix own = Matrix::Zero(), other = Matrix::Zero();
};

/// Between two places of the same closure. Speeds |lambda nx + ny| below a round-off threshold
/// count as 0.
Flux upwind_flux(const Characteristics& c, double nx, double ny);
/// Through the axis of a mirrored problem, from `left` to `right` in the direction of +x: sxx and
/// sxy are continuous, each side sends the characteristic that reaches the axis. own: left's.
Flux axis_flux(const Characteristics& left, const Characteristics& right);
/// Through a rigid wall on the side `sign` of the layer (normal (sign, 0)): the wall sends back the
/// characteristic for which sxy = sign * friction * sxx. `other` is 0.
Flux wall_flux(const Characteristics& c, double friction, int sign);

/// `flux` through a slope of a heap, outwards: throws BadParameter naming the characteristics when
/// one of them leaves the heap.
void require_entering(const Problem& problem, const Characteristics& c, const Flux& flux,
                      double spread, double x, double depth);

}  // namespace grainfield::continuum::osl
