// Area, centroid and second moments of a polygon from its corners (Roul 2.82-2.91).
#include <cmath>
#include <numbers>

#include "dem/shapes/polygon.h"

namespace grainfield::dem {

namespace {

// Integrals over the polygon relative to its first corner, so that a small outline far from the
// origin loses no digits.
struct Integrals {
  double area = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
};

Integrals integrals_of(const Outline& outline) {
  Integrals sum;
  const std::size_t n = outline.size();
  if (n < 3) return sum;
  const double ox = outline[0][0], oy = outline[0][1];
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double x0 = outline[k][0] - ox, y0 = outline[k][1] - oy;
    const double x1 = outline[k + 1][0] - ox, y1 = outline[k + 1][1] - oy;
    const double cross = x0 * y1 - x1 * y0;
    sum.area += cross / 2;
    sum.x += cross * (x0 + x1) / 6;
    sum.y += cross * (y0 + y1) / 6;
    sum.xx += cross * (x0 * x0 + x0 * x1 + x1 * x1) / 12;
    sum.yy += cross * (y0 * y0 + y0 * y1 + y1 * y1) / 12;
    sum.xy += cross * (2 * x0 * y0 + x0 * y1 + x1 * y0 + 2 * x1 * y1) / 24;
  }
  return sum;
}

}  // namespace

double area_of(const Outline& outline) { return integrals_of(outline).area; }

std::array<double, 2> centroid_of(const Outline& outline) {
  const Integrals sum = integrals_of(outline);
  if (outline.empty()) return {0, 0};
  return {outline[0][0] + sum.x / sum.area, outline[0][1] + sum.y / sum.area};
}

std::array<double, 3> second_moments_of(const Outline& outline) {
  const Integrals sum = integrals_of(outline);
  return {sum.xx - sum.x * sum.x / sum.area, sum.yy - sum.y * sum.y / sum.area,
          sum.xy - sum.x * sum.y / sum.area};
}

double polar_moment_of(const Outline& outline) {
  const std::array<double, 3> moments = second_moments_of(outline);
  return moments[0] + moments[1];
}

double circumradius_of(const Outline& outline) {
  const std::array<double, 2> centroid = centroid_of(outline);
  double radius = 0;
  for (const auto& [x, y] : outline) {
    radius = std::fmax(radius, std::hypot(x - centroid[0], y - centroid[1]));
  }
  return radius;
}

double edge_steepness(const Outline& outline) {
  const std::array<double, 2> centroid = centroid_of(outline);
  double steepest = 0, second = 0;
  for (std::size_t k = 0, n = outline.size(); k < n; ++k) {
    const auto& [x0, y0] = outline[k];
    const auto& [x1, y1] = outline[(k + 1) % n];
    const double ex = x1 - x0, ey = y1 - y0;
    // length / (cross / length)
    const double cross = ex * (centroid[1] - y0) - ey * (centroid[0] - x0);
    const double steepness = 2 * (ex * ex + ey * ey) / cross;
    second = std::fmax(second, std::fmin(steepness, steepest));
    steepest = std::fmax(steepest, steepness);
  }
  return 0.5 * (steepest + second);
}

double equal_radius(double area) { return std::sqrt(area / std::numbers::pi); }

double edge_width(const Outline& outline) {
  double longest = 0;
  for (std::size_t k = 0, n = outline.size(); k < n; ++k) {
    const auto& [x0, y0] = outline[k];
    const auto& [x1, y1] = outline[(k + 1) % n];
    longest = std::fmax(longest, std::sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0)));
  }
  return 2 * longest / equal_radius(area_of(outline));
}

}  // namespace grainfield::dem
