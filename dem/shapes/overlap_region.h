// The overlap region of two convex outlines and what a contact needs of it. Not for other rooms.
//
// The region is a closed counter-clockwise loop of points; each point says whose outline the side
// that starts there belongs to. Where that changes, the outlines cross. With sigma = +1 where A's
// outline leaves B and -1 where it enters, every quantity of the contact is a sum over the
// crossings:
//   b         = sum sigma x                  = |b| t
//   s.t |b|   = sum sigma x.x / 2            (derivative of the area by rotation)
//   s.n |b|   = sum sigma (x.t)(x.n)
// For two crossings s is their middle. Each sum changes continuously when two crossings appear or
// vanish together, as they do when a corner slides through an outline. Both positions move with the
// origin, so that it can be chosen near the contact, where nothing cancels.
#pragma once
#include <algorithm>
#include <cmath>

#include "dem/shapes/polygon.h"

namespace grainfield::dem::region {

/// Points of a loop: every corner of both outlines and every crossing, with room for round-off.
constexpr int kMostPoints = 4 * kMostCorners;

/// Below this part of the region's circumference |b| counts as 0.
constexpr double kNoChord = 1e-9;

/// The region's outline. `of_b` is 0 (1) where the side from this point to the next one is A's
/// (B's).
struct Loop {
  int n = 0;
  double x[kMostPoints], y[kMostPoints], of_b[kMostPoints];

  void add(double px, double py, double owner) {
    x[n] = px;
    y[n] = py;
    of_b[n] = owner;
    ++n;
  }
};

/// Distance of the centroid from the nearest edge, m (a disk's radius).
inline double inner_radius(const PlacedShape& shape) {
  if (shape.n == 0) return shape.radius;
  double least = shape.radius;
  for (int k = 0; k < shape.n; ++k) {
    const double ex = shape.x[k + 1] - shape.x[k], ey = shape.y[k + 1] - shape.y[k];
    const double cross = ex * (shape.cy - shape.y[k]) - ey * (shape.cx - shape.x[k]);
    least = std::fmin(least, cross / std::sqrt(ex * ex + ey * ey));
  }
  return least;
}

/// The arm that enters the characteristic length: of a deep overlap the contact point can reach the
/// centroid, and the length stays positive and bounded below.
inline double bounded_arm(const PlacedShape& shape, double arm) {
  if (arm >= kShortArm * shape.radius) return arm;
  return std::fmax(arm, kShortArm * inner_radius(shape));
}

/// Fills levers, shifts, arms and length from the contact point (sx, sy) and the normal.
inline void set_contact_point(const PlacedShape& a, const PlacedShape& b, double six, double siy,
                              Overlap& o) {
  // (six, siy) is s - x_i.
  const double sjx = six - (b.cx - a.cx), sjy = siy - (b.cy - a.cy);
  o.lever_i = six * o.nx + siy * o.ny;
  o.shift_i = siy * o.nx - six * o.ny;
  o.lever_j = -(sjx * o.nx + sjy * o.ny);
  o.shift_j = sjy * o.nx - sjx * o.ny;
  o.arm_i = std::sqrt(six * six + siy * siy);
  o.arm_j = std::sqrt(sjx * sjx + sjy * sjy);
  const double ai = bounded_arm(a, o.arm_i), aj = bounded_arm(b, o.arm_j);
  o.length = ai * aj / (ai + aj);
}

/// Circular segments beyond the sides of a loop: area, m2, and its first moments about the loop's
/// origin, m3.
struct Arcs {
  double area = 0, mx = 0, my = 0;
};

/// Where the overlap has no chord (one outline inside the other, or bars that cross
/// symmetrically): normal and depth of the least displacement of B that separates the two, among
/// the normals of all edges and, with a disk, the line of centres. s is the middle of the region,
/// (mx, my) relative to A's centroid. Sets all but the area.
void set_least_penetration(const PlacedShape& a, const PlacedShape& b, double mx, double my,
                           Overlap& overlap);

/// Mixes `overlap` (weight) with the same for the region of this loop (1 - weight); (ox, oy) is its
/// origin relative to A's centroid. The chord fades with the weight.
void hand_over(const PlacedShape& a, const PlacedShape& b, const Loop& loop, const Arcs& arcs,
               double ox, double oy, double weight, Overlap& overlap);

/// Area of a placed shape, m2.
double area_of(const PlacedShape& shape);

/// 1 for nearly every contact; less where an outline of this radius and area (a function: it is
/// seldom asked for) is all but inside the other; 0 without any chord.
template <class Area>
inline double weight_of_chord(double radius, Area area_of_smaller, double area,
                              double chord_squared) {
  const auto smooth = [](double share) {
    const double s = std::min(std::max(share, 0.0), 1.0);
    return s * s * (3 - 2 * s);
  };
  double weight = 1;
  if (chord_squared < kLastPart * area) weight = smooth(chord_squared / (kLastPart * area));
  if (area > (1 - kLastPart) * kLeastArea * radius * radius) {
    const double smaller = area_of_smaller();
    weight *= smooth((smaller - area) / (kLastPart * smaller));
  }
  return weight;
}
inline double weight_of_chord(const PlacedShape& a, const PlacedShape& b, double area,
                              double chord_squared) {
  return weight_of_chord(
      std::min(a.radius, b.radius), [&] { return std::min(area_of(a), area_of(b)); }, area,
      chord_squared);
}

/// Extents along the normal and the tangent.
struct Extents {
  double low_n = 0, high_n = 0, low_t = 0, high_t = 0;
  void include(double n, double t) {
    low_n = n < low_n ? n : low_n;
    high_n = n > high_n ? n : high_n;
    low_t = t < low_t ? t : low_t;
    high_t = t > high_t ? t : high_t;
  }
};

/// Sums of a loop relative to its first point.
struct LoopSums {
  double area = 0;                   // of the polygon of the points
  double bx = 0, by = 0;             // sum sigma x
  double sxx = 0, sxy = 0, syy = 0;  // sum sigma x x
  double circumference = 0;          // |dx| + |dy| of its sides
};

inline LoopSums sums_of(const Loop& loop) {
  LoopSums s;
  const int n = loop.n;
  const double ox = loop.x[0], oy = loop.y[0];
  double twice = 0, x = loop.x[n - 1] - ox, y = loop.y[n - 1] - oy, of_b = loop.of_b[n - 1];
  for (int i = 0; i < n; ++i) {
    const double x1 = loop.x[i] - ox, y1 = loop.y[i] - oy, of_b1 = loop.of_b[i];
    twice += x * y1 - x1 * y;
    s.circumference += std::fabs(x1 - x) + std::fabs(y1 - y);
    const double sigma = of_b1 - of_b, sx = sigma * x1, sy = sigma * y1;
    s.bx += sx;
    s.by += sy;
    s.sxx += sx * x1;
    s.sxy += sx * y1;
    s.syy += sy * y1;
    x = x1;
    y = y1;
    of_b = of_b1;
  }
  s.area = 0.5 * twice;
  return s;
}

/// Fills `overlap` from the region's loop; (ox, oy) is the loop's origin relative to A's centroid.
/// `arcs` are added to the polygon of the points; `add_arcs(extents, n_x, n_y, n_0,
/// t_0)` includes what arcs reach beyond the points, positions along n and t counted from n_0, t_0.
/// Returns false when the area is not positive. Measures::gradient: without bounds on s and without
/// the hand-over, which are no derivatives of the area.
template <class AddArcs>
inline bool contact_of_loop(const PlacedShape& a, const PlacedShape& b, const Loop& loop, double ox,
                            double oy, const Arcs& arcs, AddArcs add_arcs, Measures measures,
                            Overlap& o) {
  const LoopSums s = sums_of(loop);
  o.area = s.area + arcs.area;
  if (!(o.area > 0)) return false;
  const double squared = s.bx * s.bx + s.by * s.by;
  const double least = kNoChord * s.circumference;
  if (!(squared > least * least)) {
    o.chord = 0;
    hand_over(a, b, loop, arcs, ox, oy, 0, o);
    return true;
  }
  o.chord = std::sqrt(squared);
  const double inverse = 1 / o.chord;
  const double tx = s.bx * inverse, ty = s.by * inverse;
  o.nx = ty;
  o.ny = -tx;
  const double x0 = loop.x[0], y0 = loop.y[0];
  Extents e;
  for (int i = 1; i < loop.n; ++i) {
    const double x = loop.x[i] - x0, y = loop.y[i] - y0;
    e.include(x * ty - y * tx, x * tx + y * ty);
  }
  add_arcs(e, o.nx, o.ny, x0 * ty - y0 * tx, x0 * tx + y0 * ty);
  o.depth = e.high_n - e.low_n;
  // The sums of more than two crossings can leave the region: then its border is as far as s goes.
  double along_t = 0.5 * (s.sxx + s.syy) * inverse;
  double along_n = (tx * ty * (s.sxx - s.syy) + s.sxy * (ty * ty - tx * tx)) * inverse;
  const bool exact = measures == Measures::gradient;
  if (!exact) along_t = std::min(std::max(along_t, e.low_t), e.high_t);
  along_n = std::min(std::max(along_n, e.low_n), e.high_n);
  set_contact_point(a, b, ox + x0 + along_t * tx + along_n * ty,
                    oy + y0 + along_t * ty - along_n * tx, o);
  const double weight = exact ? 1 : weight_of_chord(a, b, o.area, squared);
  if (weight < 1) hand_over(a, b, loop, arcs, ox, oy, weight, o);
  return true;
}

/// Disk with polygon, either one first (disk_overlap.cc).
bool overlap_of_disk_and_polygon(const PlacedShape& a, const PlacedShape& b, PairFeature& feature,
                                 Measures measures, Overlap& overlap);
/// Disk with disk (disk_overlap.cc).
bool overlap_of_two_disks(const PlacedShape& a, const PlacedShape& b, Measures measures,
                          Overlap& overlap);

}  // namespace grainfield::dem::region
