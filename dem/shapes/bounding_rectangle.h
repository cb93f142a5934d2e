// Rectangles about slender grains. The circle about a grain ten times as long as wide meets ten
// times as many neighbours as the grain itself; its rectangle leaves out nearly all of these.
#pragma once
#include <array>
#include <cmath>

#include "dem/shapes/polygon.h"

namespace grainfield::dem {

/// Grains at least this many times as long as wide are slender. The others are seen as their
/// bounding circles, which turning does not change.
inline constexpr double kSlender = 1.5;

/// What a grain may reach until the next search.
struct BoundingRectangle {
  double x = 0, y = 0;                     ///< centre, m
  double ux = 1, uy = 0;                   ///< along its length
  double half_length = 0, half_width = 0;  ///< m; 0 of a circle
  double gap = 0;                          ///< kept all round, m; of a circle its radius as well
};

/// Unit vector along the principal axis with the smallest second moment, in the outline's frame;
/// (0, 0) when the outline is not slender: shorter along it than kSlender times its extent across.
std::array<double, 2> long_axis_of(const Outline& outline);

/// The smallest rectangle along (ux, uy) about the corners of `shape`, with `gap` all round.
/// ux = uy = 0: its bounding circle.
BoundingRectangle bounding_rectangle(const PlacedShape& shape, double ux, double uy, double gap);

/// True when a line along a side of one of the two keeps them apart: then what they enclose does
/// not touch, wherever it moves within the gaps.
inline bool apart(const BoundingRectangle& a, const BoundingRectangle& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const auto extent = [](const BoundingRectangle& r, double nx, double ny) {
    return r.half_length * std::fabs(r.ux * nx + r.uy * ny) +
           r.half_width * std::fabs(r.ux * ny - r.uy * nx) + r.gap;
  };
  const auto parts = [&](double nx, double ny) {
    return std::fabs(dx * nx + dy * ny) > extent(a, nx, ny) + extent(b, nx, ny);
  };
  return parts(a.ux, a.uy) || parts(-a.uy, a.ux) || parts(b.ux, b.uy) || parts(-b.uy, b.ux);
}

}  // namespace grainfield::dem
