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

}  // namespace grainfield::dem
