#include "coupling/averaging/clip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainfield::coupling {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Signed area of the triangle (origin, a, b) inside the circle about the origin.
double triangle_in_circle(const Vector2d& a, const Vector2d& b, double r) {
  const auto sector = [r](const Vector2d& p, const Vector2d& q) {
    return r * r / 2 * std::atan2(cross(p, q), p.dot(q));
  };
  const Vector2d d = b - a;
  const double dd = d.squaredNorm(), ad = a.dot(d),
               inside = ad * ad - dd * (a.squaredNorm() - r * r);
  if (dd == 0) return 0;
  if (inside <= 0) return sector(a, b);
  const double root = std::sqrt(inside), t0 = (-ad - root) / dd, t1 = (-ad + root) / dd;
  if (t1 <= 0 || t0 >= 1) return sector(a, b);
  const Vector2d p = t0 > 0 ? Vector2d(a + t0 * d) : a, q = t1 < 1 ? Vector2d(a + t1 * d) : b;
  return (t0 > 0 ? sector(a, p) : 0) + cross(p, q) / 2 + (t1 < 1 ? sector(q, b) : 0);
}

// Keeps the part where sign * (coordinate - limit) >= 0.
void cut(Corners& corners, Corners& kept, int axis, double limit, double sign) {
  kept.clear();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector2d &a = corners[k], &b = corners[k + 1 < corners.size() ? k + 1 : 0];
    const double da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
    if (da >= 0) kept.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      Vector2d at = a + da / (da - db) * (b - a);
      at[axis] = limit;
      kept.push_back(at);
    }
  }
  std::swap(corners, kept);
}

// Area of the disk of radius r in the quadrant x < a, y < b: integrates the part of each vertical
// chord below b. With clipped a, b in [-r, r].
double disk_quadrant(double r, double a, double b) {
  a = std::clamp(a, -r, r);
  b = std::clamp(b, -r, r);
  // Integral of sqrt(r^2 - x^2) from -r to x.
  const auto half = [r](double x) {
    return 0.5 * (x * std::sqrt(std::max(0.0, r * r - x * x)) + r * r * std::asin(x / r)) +
           std::numbers::pi * r * r / 4;
  };
  const double c = std::sqrt(std::max(0.0, r * r - b * b));
  const double in = std::clamp(a, -c, c);
  // Inside |x| < c the chord runs from -sqrt to b; outside it is whole (b > 0) or empty (b < 0).
  double area = b * (in + c) + half(in) - half(-c);
  if (b > 0) area += 2 * half(std::min(a, -c)) + 2 * (half(std::max(a, c)) - half(c));
  return area;
}

}  // namespace

double area_of(const Corners& corners) {
  if (corners.size() < 3) return 0;
  double area = 0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    area += cross(corners[k] - corners[0], corners[k + 1] - corners[0]) / 2;
  return area;
}

double area_in_circle(const Corners& corners, double radius) {
  double area = 0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    area += triangle_in_circle(corners[k], corners[k + 1 < corners.size() ? k + 1 : 0], radius);
  return area;
}

double area_in_box(const Corners& corners, const Vector2d& low, const Vector2d& high) {
  Corners part = corners, kept;
  kept.reserve(part.size() + 4);
  for (int axis = 0; axis < 2; ++axis) {
    cut(part, kept, axis, low[axis], 1);
    cut(part, kept, axis, high[axis], -1);
  }
  return area_of(part);
}

double disk_in_box(double r, const Vector2d& low, const Vector2d& high) {
  if (low.x() >= high.x() || low.y() >= high.y()) return 0;
  return disk_quadrant(r, high.x(), high.y()) - disk_quadrant(r, low.x(), high.y()) -
         disk_quadrant(r, high.x(), low.y()) + disk_quadrant(r, low.x(), low.y());
}

double disk_above(double r, double y0) {
  const double y = std::clamp(y0 / r, -1.0, 1.0);
  return r * r * (std::acos(y) - y * std::sqrt(1 - y * y));
}

double disk_in_disk(double distance, double r1, double r2) {
  const double small = std::min(r1, r2);
  if (distance >= r1 + r2) return 0;
  if (distance <= std::abs(r1 - r2)) return std::numbers::pi * small * small;
  // Two circular segments; the chord is at x from the first centre.
  const double x = (distance * distance + r1 * r1 - r2 * r2) / (2 * distance);
  return disk_above(r1, x) + disk_above(r2, distance - x);
}

}  // namespace grainfield::coupling
