// Walls from STL files, binary and ASCII.
#pragma once
#include <string>

#include "dem/walls/mesh.h"

namespace grainfield::dem {

struct StlOptions {
  double unit = 1;      ///< m per unit of the file: 1e-3 for millimetres
  bool inside = false;  ///< the grains are inside the body that the file bounds
  bool open = false;    ///< a thin sheet (funnel, chute) is meant; grains may be on both sides
};

/// The facets, m, counter-clockwise as the grains see them: for Wall::triangles. In the file they
/// are counter-clockwise seen from outside the body, as STL has it.
/// Throws std::invalid_argument naming the file, the facet where there is one, and what to change:
/// unreadable, cut off, not STL, more than kMostFacets; facets without area or turned against each
/// other, corners' order against the facet's own normal; not closed (unless `open`), inside out.
Triangles read_stl(const std::string& file, const StlOptions& options = {});

inline constexpr std::size_t kMostFacets = 2'000'000;

}  // namespace grainfield::dem
