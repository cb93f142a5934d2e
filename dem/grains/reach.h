// How far a grain in space reaches along a direction.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// From its centre to the plane across the unit direction n that touches it, m: of a superellipsoid
/// its support function, of a sphere the radius.
double reach_along(const Grain& grain, const Vec3& n);

/// Height of its highest and of its lowest point, z up, m.
double top_3d(const Grain& grain);
double bottom_3d(const Grain& grain);

}  // namespace grainfield::dem
