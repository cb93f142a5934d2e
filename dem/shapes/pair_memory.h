// What pairs of polygons remember (PairFeature), as numbers, and what decides that a remembered
// crossing still holds. Constants alone: files that are compiled for several widths read them, too.
#pragma once
#include <cstdint>

namespace grainfield::dem {

/// Corners a polygon can have at most.
inline constexpr int kMostCorners = 64;

// The memory: 0 nothing; up to kMostHint 1 + 2 edge + (0: A's, 1: B's), the separating edge;
// with kCrossed the edges of the crossings, six bits each: A's on which its outline enters and
// leaves B, then B's on which it enters and leaves A.
inline constexpr std::uint32_t kMostHint = 2 * kMostCorners;
inline constexpr std::uint32_t kCrossed = 1u << 30;

/// Share of (r_i + r_j)^2: a larger region is more than round-off (some 100 times its bound).
inline constexpr double kSureArea = 1e-13;

/// A chord hands over to least penetration, so that a grain is swallowed without a leap, while the
/// last kLastPart of the smaller outline's area goes in, and where the chord's square is below
/// kLastPart of the overlap's area (bars that cross nearly symmetrically, the tip of a needle).
inline constexpr double kLastPart = 0.02;
/// Area over the square of the radius is at least this: a triangle of slenderness 20 has 1/17.6.
inline constexpr double kLeastArea = 1.0 / 40;
/// In the characteristic length an arm below this share of the radius may be bounded.
inline constexpr double kShortArm = 0.25;

}  // namespace grainfield::dem
