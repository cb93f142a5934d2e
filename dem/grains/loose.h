// Grains placed loosely: at random, and apart from each other.
#pragma once
#include <array>
#include <vector>

#include "dem/random/random.h"

namespace grainfield::dem {

/// Share of the box that balls may fill at most before random places become rare: random
/// sequential addition ends at 0.547 (2D) and 0.38 (3D) for equal ones.
inline constexpr double kMostLoose2 = 0.5, kMostLoose3 = 0.33;

/// Centres, m, of balls of these radii in a box from the origin to `size` (in 2D size[2] is not
/// used and z is 0), uniform but without overlap: one after the other, the largest first.
/// `periodic`: the box repeats along its edges, else all of a ball is inside. Throws
/// ComputationFailed when no place is found for one.
std::vector<std::array<double, 3>> place_loosely(const std::vector<double>& radii,
                                                 const std::array<double, 3>& size, int dim,
                                                 bool periodic, Random& random);

}  // namespace grainfield::dem
