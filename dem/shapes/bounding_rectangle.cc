#include "dem/shapes/bounding_rectangle.h"

#include <algorithm>
#include <limits>

namespace grainfield::dem {
namespace {

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double half() const { return (high - low) / 2; }
  double middle() const { return (high + low) / 2; }
};

}  // namespace

std::array<double, 2> long_axis_of(const Outline& outline) {
  if (outline.empty()) return {0, 0};
  const auto [xx, yy, xy] = second_moments_of(outline);
  // Half the angle of (xx - yy, 2 xy), by square roots alone: the same bits on every machine.
  const double size = std::sqrt((xx - yy) * (xx - yy) + 4 * xy * xy);
  if (size == 0) return {0, 0};
  const double twice = (xx - yy) / size;
  const double ux = std::sqrt(0.5 * std::max(0.0, 1 + twice));
  const double uy = std::copysign(std::sqrt(0.5 * std::max(0.0, 1 - twice)), xy);
  Range along, across;
  for (const auto& [x, y] : outline) {
    along.include(x * ux + y * uy);
    across.include(y * ux - x * uy);
  }
  if (along.half() < kSlender * across.half()) return {0, 0};
  return {ux, uy};
}

BoundingRectangle bounding_rectangle(const PlacedShape& shape, double ux, double uy, double gap) {
  if (ux == 0 && uy == 0) return {shape.cx, shape.cy, 1, 0, 0, 0, shape.radius + gap};
  Range along, across;
  for (int k = 0; k < shape.n; ++k) {
    along.include(shape.x[k] * ux + shape.y[k] * uy);
    across.include(shape.y[k] * ux - shape.x[k] * uy);
  }
  const double u = along.middle(), v = across.middle();
  return {u * ux - v * uy, u * uy + v * ux, ux, uy, along.half(), across.half(), gap};
}

}  // namespace grainfield::dem
