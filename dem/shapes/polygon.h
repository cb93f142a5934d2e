// Convex polygons: their geometry, and what two of them overlap in.
//
// Contact of two convex outlines A and B (Roul ch. 2; physics section 2). The overlap region C is
// bounded by pieces of A's outline inside B and pieces of B's outline inside A. With
//   b = sum of the vectors along A's pieces, counter-clockwise   (= p2 - p1 for two crossings)
// the overlap area obeys dA = -|b| n . du for a displacement du of B against A, n = b turned by -90
// degrees (out of A, towards B), so n is the normal, t = (-n_y, n_x) the tangent and |b| the
// chord for any number of crossings. Roul's force E A / l along n is not the gradient of a
// potential: l changes with the place too, so it does work round closed loops (docs/piles.md). The
// contact point s has the tangential position that makes the torque equal to the area's derivative
// by rotation,
//   s . t = sum over A's pieces (|end|^2 - |begin|^2) / (2 |b|)
// and the normal position
//   s . n = sum over A's pieces ((end.t)(end.n) - (begin.t)(begin.n)) / |b|,
// both the middle of p1p2 for two crossings; of more crossings kept within the overlap's extents.
// Area, b and s change continuously while corners slide in and out (b jumps only where sides are
// parallel; coincident sides that face the same way count as B's). The depth is the extent of the
// overlap along n. Where b = 0 (one outline inside the other, two bars crossing symmetrically) the
// normal is the direction of least penetration, the depth that penetration, the chord 0 and s the
// middle of the overlap (the inner one's centroid). While the last 2 % of the smaller outline's
// area goes in, and where |b|^2 is below 2 % of the overlap's area, normal, depth and s go over to
// these smoothly and the chord fades: there they are not the area's derivatives any more. Where the
// normal turns into its opposite on that way, l grows and the force passes through 0.
// l = r_i r_j / (r_i + r_j), r_i, r_j the distances of s from the centroids (arm_i, arm_j). In l,
// and only there, an arm is at least a quarter of the centroid's distance from the nearest edge: l
// stays positive when s comes near a centroid.
#pragma once
#include <cstdint>

#include "dem/shapes/disk.h"
#include "dem/shapes/pair_memory.h"
#include "dem/space/outline.h"

namespace grainfield::dem {

/// An outline where it is. n = 0: a disk of `radius` about (cx, cy).
struct PlacedShape {
  const double* x =
      nullptr;  ///< n + 1 corners, counter-clockwise, the first one repeated at the end
  const double* y = nullptr;
  int n = 0;
  double cx = 0, cy = 0;  ///< centroid, m
  double radius = 0;      ///< from the centroid to the farthest corner, m
};

/// What a pair remembers from step to step so that the narrow phase starts from last step's
/// separating feature. It never changes a result, only its cost. All bits 0: nothing yet.
struct PairFeature {
  std::int32_t hint = 0;
};

/// Fills `overlap` (area, chord, length, levers and shifts included). Returns false when the shapes
/// do not overlap (touching counts as not). Polygon with polygon, disk with polygon, disk with
/// disk.
/// With Measures::gradient normal, chord and contact point are the area's derivatives wherever
/// there is a chord, and the chord does not fade; the length is left to set_constant_length.
bool overlap_of_shapes(const PlacedShape& a, const PlacedShape& b, PairFeature& feature,
                       Overlap& overlap, Measures measures = Measures::area);
/// The same with a half plane: (px, py) on it, (wx, wy) its outward unit normal. The plane's own
/// arm is infinite, so l = arm_i.
bool overlap_with_half_plane(const PlacedShape& a, double px, double py, double wx, double wy,
                             Overlap& overlap, Measures measures = Measures::area);

/// l0 of two grains whose circles of equal area have these radii, m. A wall's is infinite.
inline void set_constant_length(double equal_i, double equal_j, Overlap& overlap) {
  overlap.length = equal_i * equal_j / (equal_i + equal_j);
}
/// Radius of the circle of this area, m.
double equal_radius(double area);

/// Area, m2 (positive for counter-clockwise corners).
double area_of(const Outline& outline);
std::array<double, 2> centroid_of(const Outline& outline);
/// Polar second moment of area about the centroid, m4: inertia = density * this (Roul 2.82-2.91).
double polar_moment_of(const Outline& outline);
/// Second moments of area about the centroid: integral of x x, y y, x y, m4.
std::array<double, 3> second_moments_of(const Outline& outline);
/// Largest distance of a corner from the centroid, m.
double circumradius_of(const Outline& outline);
/// 2 length / distance of the edge from the centroid, mean of the two edges where it is largest:
/// bounds the stiffness over E of the edge-on-edge contacts on the grain's two sides (engine.h:
/// stable_time_step).
double edge_steepness(const Outline& outline);

/// 2 length / radius of equal area of the longest edge: the largest chord / l0 of two such grains.
double edge_width(const Outline& outline);

/// The outline with its centroid at the origin, counter-clockwise. Throws std::invalid_argument
/// saying what is wrong and with which corner: fewer than 3 corners, a value that is not finite,
/// corners that coincide, an outline that crosses itself, that is not convex, or that is a sliver
/// (slenderness, longest over shortest extent, above 20).
Outline centred_outline(const Outline& corners);

}  // namespace grainfield::dem
