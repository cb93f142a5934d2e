// Stresses of space in the axes of a cylinder about the vertical.
#pragma once
#include "continuum/model.h"

namespace grainfield::continuum {

/// rr, tt, zz, tz, rz, rt of the stresses xx, yy, zz, yz, xz, xy at the points (n x 3): r away from
/// the vertical through the origin, t along the circle, counter-clockwise from above. On the axis r
/// is x.
Stresses in_cylindrical_axes(const Points& points, const Stresses& stresses);

}  // namespace grainfield::continuum
