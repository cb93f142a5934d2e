// nu c against tr F, and g2 = tr F / (nu c): what the spread of sizes does to the fabric.
//
// tr<F> = (1/V) sum V_p c_p, nu c = (1/V) sum V_p * (1/N) sum c_p, so g2 is 1 for equal grains and
// above it when large grains have more contacts (Roul 3.3, 3.4). Madadi, Tsoungui, Laetzel, Luding,
// Int. J. Solids Struct. 41 (2004) 2563: when the share of a grain's surface that neighbours cover
// does not depend on its size, c(a) is proportional to 1/Omega(a), Omega the angle under which
// grain a sees a neighbour of mean radius a0:
//   2D: Omega = 2 arcsin(1/(1 + a/a0));  3D: Omega = 2 pi (1 - sqrt(1 - 1/(1 + a/a0)^2)),
// and g2 = <V/Omega> / (<V> <1/Omega>) (Shaebani et al., Phys. Rev. E 85 (2012) 011301, in 3D).
#pragma once
#include <Eigen/Core>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct SizeFactor {
  int grains = 0;           ///< free grains counted
  double coordination = 0;  ///< c: mean contacts per grain
  double measured = 0;      ///< g2 = N sum V_p c_p / (sum V_p sum c_p); nan without contacts
  double theory = 0;        ///< Madadi et al. from the radii of these grains
};

/// Over the free grains of the snapshot, rattlers included. Radius of a polygon: of the disk of its
/// area. Throws std::invalid_argument without a free grain.
SizeFactor size_factor(const dem::Snapshot& snapshot);

/// g2 of radii (m) by Madadi et al., sizes drawn from them; dim 2 or 3. At least one radius.
double size_factor_theory(const Eigen::VectorXd& radii, int dim);

}  // namespace grainfield::coupling
