// A wall of triangles.
//
// A grain touches it where the distance from its centre has a local minimum: inside a triangle, on
// an edge that bulges towards it, or at such a corner. So an edge between two triangles of one
// plane is not felt, nor is it counted twice, and in a corner of a box there are three contacts.
// Where facets stand for a curved surface that lies around the grain, neighbouring minima whose
// directions differ by less than kSmoothAngle are one contact, the deepest one.
// A closed mesh pushes on the side from which its triangles are counter-clockwise; an open one is
// thin and pushes on both.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "dem/space/space3.h"
#include "dem/walls/surface.h"

namespace grainfield::dem {

using Triangles = std::vector<std::array<Vec3, 3>>;

/// cos 20 degrees: facets of a round wall with 18 or more around it are one surface.
inline constexpr double kSmoothCosine = 0.93969262078590838;

/// Corners with indices, and what meets where.
struct MeshTopology {
  std::vector<Vec3> corners;
  std::vector<std::array<int, 3>> triangles;
  /// By triangle and edge (from corner k to k + 1): the triangle beyond, or -1.
  std::vector<std::array<int, 3>> beyond;
  bool closed = true;
  double volume = 0;  ///< m3, above 0 when triangles are counter-clockwise seen from outside
};

/// Corners with equal coordinates are one. Throws std::invalid_argument beginning with `what` and
/// naming the facet (from 1): without area, an edge of more than two facets, neighbours that are
/// turned against each other, a coordinate that is no number, no facet at all.
MeshTopology topology_of(const Triangles& triangles, const std::string& what);

/// Surface by corners relative to the frame's origin. Throws as topology_of.
std::unique_ptr<WallSurface<3>> mesh_surface(const Triangles& triangles, const std::string& what);

}  // namespace grainfield::dem
