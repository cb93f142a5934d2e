#include "coupling/specimen/volume_fraction.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dem/grains/placed.h"
#include "dem/shapes/polygon.h"

namespace grainfield::coupling {
namespace {

using dem::Grain;
using dem::Outline;
using dem::Snapshot;

constexpr int kDiskCorners = 64;
// Diameters: distance of the windows below the flanks' lines, thickness of the flanks' windows,
// least width of any.
constexpr double kBelowSurface = 1.5, kFlankThickness = 4, kLeastWidth = 4;
constexpr double kCentreWidth = 0.15, kCentreHeight = 0.6, kWholeHeight = 0.85;
constexpr double kFlankFrom = 0.2, kFlankTo = 0.75;  // shares of the flank's length

// Keeps what lies to the left of the line from p to q (Sutherland and Hodgman).
void clip(Outline& corners, const std::array<double, 2>& p, const std::array<double, 2>& q,
          Outline& scratch) {
  scratch.clear();
  const auto side = [&](const std::array<double, 2>& c) {
    return (q[0] - p[0]) * (c[1] - p[1]) - (q[1] - p[1]) * (c[0] - p[0]);
  };
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto& a = corners[k];
    const auto& b = corners[(k + 1) % corners.size()];
    const double sa = side(a), sb = side(b);
    if (sa >= 0) scratch.push_back(a);
    if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0)) {
      const double t = sa / (sa - sb);
      scratch.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
    }
  }
  corners.swap(scratch);
}

Outline disk_outline(const Grain& g) {
  // Corners a little outside the circle, so that the area is the disk's.
  const double step = 2 * std::numbers::pi / kDiskCorners;
  const double r = g.radius * std::sqrt(step / std::sin(step));
  Outline out;
  for (int k = 0; k < kDiskCorners; ++k) {
    out.push_back(
        {g.position.x() + r * std::cos(k * step), g.position.y() + r * std::sin(k * step)});
  }
  return out;
}

double height_of(const FlankLine& line, double x) { return line.at_zero + line.slope * x; }
double place_of(const FlankLine& line, double y) { return (y - line.at_zero) / line.slope; }

// Between the flank's line and one below it, both at constant vertical distance.
Outline flank_window(const FlankLine& line, double height, double diameter) {
  const double cosine = 1 / std::sqrt(1 + line.slope * line.slope);
  const double top = kBelowSurface * diameter / cosine;
  const double bottom = (kBelowSurface + kFlankThickness) * diameter / cosine;
  const double from = std::max(kFlankFrom * height, bottom + diameter);
  double x0 = place_of(line, from), x1 = place_of(line, kFlankTo * height);
  if (from >= kFlankTo * height || std::fabs(x1 - x0) < kLeastWidth * diameter) return {};
  if (x0 > x1) std::swap(x0, x1);
  return {{x0, height_of(line, x0) - bottom},
          {x1, height_of(line, x1) - bottom},
          {x1, height_of(line, x1) - top},
          {x0, height_of(line, x0) - top}};
}

}  // namespace

double common_area(const Outline& a, const Outline& b) {
  Outline rest = a, scratch;
  for (std::size_t k = 0; k < b.size() && !rest.empty(); ++k) {
    clip(rest, b[k], b[(k + 1) % b.size()], scratch);
  }
  return rest.size() < 3 ? 0 : dem::area_of(rest);
}

double volume_fraction(const Snapshot& snapshot, const Outline& window) {
  const double area = window.size() < 3 ? 0 : dem::area_of(window);
  if (!(area > 0)) throw std::invalid_argument("volume_fraction: the window has no area");
  double left = window[0][0], right = left, low = window[0][1], high = low;
  for (const auto& p : window) {
    left = std::min(left, p[0]);
    right = std::max(right, p[0]);
    low = std::min(low, p[1]);
    high = std::max(high, p[1]);
  }
  double sum = 0;
  for (const Grain& g : snapshot.grains) {
    const double x = g.position.x(), y = g.position.y(), r = 1.01 * g.radius;
    if (g.fixed || x + r < left || x - r > right || y + r < low || y - r > high) continue;
    sum += common_area(g.outline.empty() ? disk_outline(g) : dem::placed_outline(g), window);
  }
  return sum / area;
}

HeapWindows windows_of(const HeapShape& heap, double diameter) {
  HeapWindows w;
  if (!std::isfinite(heap.apex_x)) return w;
  // The flanks' lines, lowered.
  const auto lowered = [&](const FlankLine& line) {
    FlankLine out = line;
    out.at_zero -= kBelowSurface * diameter * std::sqrt(1 + line.slope * line.slope);
    return out;
  };
  const FlankLine left = lowered(heap.left), right = lowered(heap.right);
  const double floor = diameter;
  const double meet = (left.at_zero - right.at_zero) / (right.slope - left.slope);
  const double peak = height_of(left, meet);
  const double top = std::min(peak, kWholeHeight * heap.height);
  const double width_below = place_of(right, floor) - place_of(left, floor);
  if (top >= (1 + kLeastWidth) * diameter && width_below >= kLeastWidth * diameter) {
    w.whole = {{place_of(left, floor), floor}, {place_of(right, floor), floor}};
    // Where the lines meet below the ceiling there is one corner: two that differ by rounding could
    // stand the wrong way round.
    if (peak <= top) {
      w.whole.push_back({meet, peak});
    } else {
      w.whole.push_back({place_of(right, top), top});
      w.whole.push_back({place_of(left, top), top});
    }
  }
  const double x0 = heap.apex_x - kCentreWidth * heap.half_base_left();
  const double x1 = heap.apex_x + kCentreWidth * heap.half_base_right();
  const double ceiling =
      std::min({kCentreHeight * heap.height, height_of(left, x0), height_of(right, x1)});
  if (x1 - x0 >= kLeastWidth * diameter && ceiling >= (1 + kLeastWidth) * diameter) {
    w.centre = {{x0, floor}, {x1, floor}, {x1, ceiling}, {x0, ceiling}};
  }
  w.surface_left = flank_window(heap.left, heap.height, diameter);
  w.surface_right = flank_window(heap.right, heap.height, diameter);
  return w;
}

}  // namespace grainfield::coupling
