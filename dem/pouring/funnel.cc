#include "dem/pouring/funnel.h"

#include <cmath>
#include <numbers>

namespace grainfield::dem {
namespace {

constexpr double kSlope = std::numbers::sqrt3;  // tan 60 degrees: grains slide, friction up to 1.7
// In widths of the mouth.
constexpr double kRise = 3, kThickness = 0.5;

}  // namespace

double funnel_rise(const SourceSetup& source) { return kRise * source.opening; }

double funnel_half_width(const SourceSetup& source) {
  return 0.5 * source.opening + funnel_rise(source) / kSlope;
}

double funnel_room(const SourceSetup& source, double radius) {
  return funnel_half_width(source) - radius * std::sqrt(1 + 1 / (kSlope * kSlope));  // r/sin 60
}

double funnel_half_span(const SourceSetup& source) {
  return funnel_half_width(source) + kThickness * source.opening;
}

std::vector<NewGrain> funnel_plates(const SourceSetup& source, double density) {
  if (source.opening == 0) return {};
  const double rise = funnel_rise(source), thickness = kThickness * source.opening;
  // Half the diagonals of the right plate, from its middle; the left one is its mirror image.
  const double x1 = 0.5 * (rise / kSlope + thickness), x2 = 0.5 * (rise / kSlope - thickness);
  const double y = 0.5 * rise;
  NewGrain right;
  right.fixed = true;
  right.density = density;
  right.x = 0.5 * source.opening + x1;
  right.y = source.height + y;
  right.outline = {{-x1, -y}, {-x2, -y}, {x1, y}, {x2, y}};
  NewGrain left = right;
  left.x = -right.x;
  left.outline = {{x1, -y}, {-x2, y}, {-x1, y}, {x2, -y}};
  return {left, right};
}

}  // namespace grainfield::dem
