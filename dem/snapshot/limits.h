// Bounds of what a packing may hold, for files of ours and for those that are imported.
#pragma once

namespace grainfield::dem {

/// No number of a packing is larger in size, in SI units: squares of forces and velocities, and
/// sums of many, stay finite.
inline constexpr double kMostNumber = 1e100;
/// Tolerance of a quaternion's or normal's length, and of a normal force from force and normal,
/// relative: what is written with six digits.
inline constexpr double kUnitTolerance = 1e-5;
/// A contact point lies this many radii of the larger grain from both centres at most: contacts of
/// stiff grains lie within one.
inline constexpr double kMostRadii = 10;

}  // namespace grainfield::dem
