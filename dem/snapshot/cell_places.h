// Places in and out of a periodic cell.
#pragma once
#include <array>
#include <stdexcept>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// A place more than kMostImages edges of the cell away (images.h).
class TooFarAway : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// The edges by which wrapped() carries a place back: place = wrapped + edges n. Throws TooFarAway.
std::array<int, 3> edges_away(const Cell<3>& cell, const Vec3& place);
/// How far a place lies out of the cell, along its edges, m; 0 within it.
double depth_outside(const Cell<3>& cell, const Vec3& place);
/// Coordinates of a vector along the periodic edges, in edges; 0 along the other axes. What is
/// across all periodic edges has none: the least squares' coordinates.
Vec3 along_edges(const Cell<3>& cell, const Vec3& v);
/// Columns: the edges of `before` in those of `after`, whole numbers, as image_in() (images.h) has
/// them. The identity where nothing was exchanged.
Eigen::Matrix3i edges_exchanged(const Cell<3>& after, const Cell<3>& before);

}  // namespace grainfield::dem
