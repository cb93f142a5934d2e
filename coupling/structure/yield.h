// How near a stress is to the Mohr-Coulomb limit.
#pragma once
#include <string>

#include "coupling/base/field.h"

namespace grainfield::coupling {

/// (sxx - syy)^2 + 4 sxy^2 - (sxx + syy)^2 sin^2 phi (Roul 4.2), (N/m)^2: 0 at the limit of a
/// cohesionless material, negative inside.
double mohr_coulomb_expression(double xx, double yy, double xy, double phi_deg);

/// The friction angle at which this stress would be at the limit: arcsin(sqrt((sxx - syy)^2 + 4
/// sxy^2) / -(sxx + syy)), deg; nan without compression, 90 where a principal stress is tensile.
double mobilised_friction_deg(double xx, double yy, double xy);

/// Adds to a 2D field with sigma_xx, sigma_yy, sigma_xy (and sigma_yx: their mean):
/// mohr_coulomb (the expression over (sxx + syy)^2: 0 at the limit, -sin^2 phi without shear; 1)
/// and mobilised_friction (deg); nan where the stress is. Throws std::invalid_argument: a missing
/// column, phi outside (0, 90).
void add_yield_columns(Field& field, double phi_deg);

}  // namespace grainfield::coupling
