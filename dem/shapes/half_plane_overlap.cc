// Overlap of a polygon or a disk with a half plane. The normal is the plane's.
#include "dem/shapes/overlap_region.h"

namespace grainfield::dem {

namespace {

// Fills all but area, depth and chord; (sx, sy) is s - x_i.
void set_plane_contact(const PlacedShape& a, double wx, double wy, double sx, double sy,
                       Overlap& o) {
  o.nx = -wx;
  o.ny = -wy;
  o.lever_i = sx * o.nx + sy * o.ny;
  o.shift_i = sy * o.nx - sx * o.ny;
  o.lever_j = o.shift_j = 0;
  o.arm_i = std::sqrt(sx * sx + sy * sy);
  o.arm_j = 0;
  o.length = region::bounded_arm(a, o.arm_i);
}

double weight_of_chord_in_plane(const PlacedShape& a, const Overlap& o) {
  return region::weight_of_chord(
      a.radius, [&] { return region::area_of(a); }, o.area, o.chord * o.chord);
}

}  // namespace

bool overlap_with_half_plane(const PlacedShape& a, double px, double py, double wx, double wy,
                             Overlap& o, Measures measures) {
  const bool exact = measures == Measures::gradient;
  const double centre = (a.cx - px) * wx + (a.cy - py) * wy;
  if (centre >= a.radius) return false;
  if (a.n == 0) {
    overlap_with_plane<true>(centre, a.radius, wx, wy, o);
    const double weight = exact ? 1 : weight_of_chord_in_plane(a, o);
    o.lever_i = weight * o.arm_i;  // wholly inside, s is the centre
    o.chord *= weight;
    o.lever_j = o.shift_i = o.shift_j = 0;
    return true;
  }
  // Fan of triangles from the first crossing (or corner): area and first moments; the crossings are
  // the outline's two ends.
  double area = 0, deepest = 0, ox = 0, oy = 0, fx = 0, fy = 0, mx = 0, my = 0;
  double crossing_x = 0, crossing_y = 0;
  int points = 0, crossings = 0;
  double bx = 0, by = 0;
  const auto add = [&](double x, double y) {
    if (points++ == 0) {
      ox = x;
      oy = y;
      return;
    }
    const double gx = x - ox, gy = y - oy, cross = fx * gy - gx * fy;
    area += cross / 2;
    mx += cross * (fx + gx) / 6;
    my += cross * (fy + gy) / 6;
    fx = gx;
    fy = gy;
  };
  const auto height = [&](int k) { return (a.x[k] - px) * wx + (a.y[k] - py) * wy; };
  double h0 = height(0);
  for (int k = 0; k < a.n; ++k) {
    const double x0 = a.x[k] - a.cx, y0 = a.y[k] - a.cy;
    const double h1 = height(k + 1);
    if (h0 < 0) {
      add(x0, y0);
      deepest = std::min(deepest, h0);
    }
    if ((h0 < 0) != (h1 < 0)) {
      const double t = h0 / (h0 - h1);
      const double x = x0 + t * (a.x[k + 1] - a.x[k]), y = y0 + t * (a.y[k + 1] - a.y[k]);
      add(x, y);
      ++crossings;
      crossing_x += x;
      crossing_y += y;
      bx += h0 < 0 ? x : -x;
      by += h0 < 0 ? y : -y;
    }
    h0 = h1;
  }
  if (!(area > 0)) return false;
  o.area = area;
  o.depth = -deepest;
  // t = (-n_y, n_x) = (w_y, -w_x)
  o.chord = crossings > 0 ? std::max(bx * wy - by * wx, 0.0) : 0.0;
  double sx = 0, sy = 0, weight = 0;  // the middle of the crossings, and its part
  if (crossings > 0) {
    sx = crossing_x / crossings;
    sy = crossing_y / crossings;
    weight = exact ? 1 : weight_of_chord_in_plane(a, o);
    o.chord *= weight;
  }
  if (weight < 1) {
    const double middle_x = ox + mx / area, middle_y = oy + my / area;
    sx = middle_x + weight * (sx - middle_x);
    sy = middle_y + weight * (sy - middle_y);
  }
  set_plane_contact(a, wx, wy, sx, sy, o);
  return true;
}

}  // namespace grainfield::dem
