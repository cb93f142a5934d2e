// Corners of a convex polygon in its body frame.
#pragma once
#include <array>
#include <vector>

namespace grainfield::dem {

/// Counter-clockwise corners, m, relative to the centroid at rotation angle 0. Empty: a disk.
using Outline = std::vector<std::array<double, 2>>;

}  // namespace grainfield::dem
