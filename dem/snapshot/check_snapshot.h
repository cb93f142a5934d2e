// What a snapshot must be so that all others can take it as it is.
#pragma once
#include <string>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Words of Wall::shape.
const std::vector<std::string>& wall_shapes();

/// Throws std::invalid_argument, its text beginning with `where`, for contacts of unknown grains or
/// walls or of a grain with itself, images along axes that are not periodic or of walls, edges of a
/// cell that span nothing, walls of unknown shape, of no size or without triangles, and in 3D for
/// orientations that are no unit quaternions and free grains whose moments are not positive. For
/// radii, volumes and masses that are not positive (fixed grains may have no mass and no volume),
/// ids that repeat, loads on grains that are not there, normals of contacts and walls that are no
/// unit vectors, normal forces other than force and normal say, points of contacts far from their
/// grains (limits.h), and coefficients of friction below 0.
void check_snapshot(const Snapshot& snapshot, const std::string& where);

}  // namespace grainfield::dem
