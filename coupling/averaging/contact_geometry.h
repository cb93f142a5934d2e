// How the shapes of two grains in contact, or of one and a wall, lie to each other.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Share of the smaller radius up to which a gap counts as touch: what files leave of places with
/// six or seven digits.
inline constexpr double kGap = 1e-6;

/// Width of the gap between the two bodies of a contact, m; 0 or less where they touch or overlap,
/// and where a wall is no plane. Of polygons the width along the best of their edges' normals (and
/// of the line from a disk's centre to the nearest corner): 0 or less exactly where they touch.
double gap_of(const dem::Snapshot& s, const dem::Contact& c);

/// The point of a disk, sphere, polygon or superellipsoid that is farthest along a unit vector, m.
dem::Vec3 farthest_along(const dem::Grain& grain, const dem::Vec3& direction);

/// Contact of two superellipsoids or spheres in space, at `branch` from first to second, m.
struct CommonPlane {
  dem::Vec3 normal, point;  ///< unit, from the first to the second; from the first's centre, m
  double gap = 0;           ///< m; below 0: overlap
};
CommonPlane common_plane(const dem::Grain& first, const dem::Grain& second,
                         const dem::Vec3& branch);

/// Leaves out the contacts that bear no force across a gap; returns how many.
std::size_t leave_out_idle(dem::Snapshot& s);
/// How many such contacts there are.
std::size_t count_idle(const dem::Snapshot& s);
/// That so many were left out, a sentence; empty: none.
std::string idle_text(std::size_t count);

}  // namespace grainfield::coupling
