// Local refinement of a mesh of triangles without hanging nodes. Internal to fe/.
//
// deal.II refines triangles all at once only; so they are cut here, each across its longest edge
// (Rivara 1984): a marked triangle is cut together with its neighbour over that edge, after the
// neighbour has been cut as often as it takes to have the same longest edge. The least angle does
// not fall below half of what it was.
#pragma once
#include <vector>

#include "continuum/fe/quadratic_triangles.h"

namespace grainfield::continuum::fe {

/// Cuts the marked triangles (one flag each). Vertices keep their numbers, new ones follow;
/// `parent` gets for each new triangle the number it had in `mesh`. Deterministic.
TriangleMesh refined(const TriangleMesh& mesh, const std::vector<bool>& marked,
                     std::vector<int>& parent);

/// Marks the triangles with the largest errors that together hold this share of the sum of squares.
std::vector<bool> largest_errors(const std::vector<double>& errors, double share);

}  // namespace grainfield::continuum::fe
