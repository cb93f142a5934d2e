// Overlap of a disk with a convex polygon, and of two disks.
//
// Each edge of the polygon is cut by the circle; what lies inside, joined by the arcs between where
// the outline leaves the disk and where it enters again, bounds the region. Its area is that of the
// polygon of those points and one circular segment per arc, so that a light contact has no
// cancellation of sectors.
#include <numbers>
#include <stdexcept>

#include "dem/shapes/overlap_region.h"

namespace grainfield::dem::region {

namespace {

// Half chords below this share of the radius are no contact of circle and edge (the disk protrudes
// by less than 1e-14 of its radius: round-off).
constexpr double kLeastHalfChord = 1e-7;

// The polygon edge k seen from the disk's centre.
struct Edge {
  double px, py, ex, ey, squared, cross;  // cross > 0: centre on the inner side

  Edge(const PlacedShape& polygon, int k, const PlacedShape& disk)
      : px(polygon.x[k] - disk.cx),
        py(polygon.y[k] - disk.cy),
        ex(polygon.x[k + 1] - polygon.x[k]),
        ey(polygon.y[k + 1] - polygon.y[k]),
        squared(ex * ex + ey * ey),
        cross(px * ey - py * ex) {}
  // The whole disk is on the outer side.
  bool separates(double radius) const {
    return cross < 0 && cross * cross >= radius * radius * squared;
  }
};

// The region's points, relative to the disk's centre; returns its arcs' segments.
Arcs arcs_of(const Loop& loop, double arc, double radius, bool centre_inside) {
  double size = 0;  // of the region's points
  for (int i = 1; i < loop.n; ++i) {
    size = std::max(size, std::fabs(loop.x[i] - loop.x[0]) + std::fabs(loop.y[i] - loop.y[0]));
  }
  Arcs arcs;
  for (int i = 0; i < loop.n; ++i) {
    if (loop.of_b[i] != arc) continue;
    const int next = i + 1 < loop.n ? i + 1 : 0;
    const double qx = loop.x[i], qy = loop.y[i];
    const double dx = loop.x[next] - qx, dy = loop.y[next] - qy;
    const double half = 0.5 * std::sqrt(dx * dx + dy * dy);
    // Distance of the centre from the chord, to its left.
    double arm = half > 0 ? -(dx * qy - dy * qx) / (2 * half) : radius;
    // The arc of a chord that is round-off is the whole circle only if nothing else is there.
    if (half < kLeastHalfChord * radius) arm = size < 1e-6 * radius && centre_inside ? -1 : 1;
    // Near a diameter the half chord alone says little about the angle.
    arcs.area += half < 0.7 * radius ? segment_area(radius, arm, half)
                                     : radius * radius * arc_of(half, arm) - half * arm;
    // A segment's first moment about the centre is 2/3 of its half chord cubed, away from it.
    const double moment = half * half / 3;
    arcs.mx += moment * dy;
    arcs.my -= moment * dx;
  }
  return arcs;
}

bool overlap_of_disk_and_outline(const PlacedShape& disk, const PlacedShape& polygon,
                                 const PlacedShape& a, const PlacedShape& b, PairFeature& feature,
                                 Measures measures, Overlap& o) {
  const double radius = disk.radius, radius2 = radius * radius;
  const auto hint = static_cast<std::uint32_t>(feature.hint);
  if (hint != 0 && hint <= static_cast<std::uint32_t>(polygon.n) &&
      Edge(polygon, static_cast<int>(hint) - 1, disk).separates(radius)) {
    return false;
  }
  const double outline = &polygon == &a ? 0.0 : 1.0, arc = 1.0 - outline;
  Loop loop;
  bool centre_inside = true, in_disk = false;
  for (int k = 0; k < polygon.n; ++k) {
    const Edge e(polygon, k, disk);
    if (e.separates(radius)) {
      feature.hint = k + 1;
      return false;
    }
    centre_inside = centre_inside && e.cross > 0;
    if (k == 0) in_disk = e.px * e.px + e.py * e.py < radius2;
    const bool begin_in = in_disk;
    const double qx = polygon.x[k + 1] - disk.cx, qy = polygon.y[k + 1] - disk.cy;
    const bool end_in = qx * qx + qy * qy < radius2;
    in_disk = end_in;
    if (begin_in) loop.add(e.px, e.py, outline);
    if (begin_in && end_in) continue;
    // Along the edge, in parts of it: the foot of the centre, and half the chord.
    const double under = radius2 * e.squared - e.cross * e.cross;
    const double half2 = under / (e.squared * e.squared);
    const double foot = -(e.px * e.ex + e.py * e.ey) / e.squared;
    if (!begin_in && !end_in) {
      if (!(half2 * e.squared > kLeastHalfChord * kLeastHalfChord * radius2)) continue;
      if (!(foot > 0 && foot < 1)) continue;
    }
    const double half = std::sqrt(half2 > 0 ? half2 : 0.0);
    if (!begin_in) {
      const double t = std::clamp(foot - half, 0.0, 1.0);
      loop.add(e.px + t * e.ex, e.py + t * e.ey, outline);
    }
    if (!end_in) {
      const double t = std::clamp(foot + half, 0.0, 1.0);
      loop.add(e.px + t * e.ex, e.py + t * e.ey, arc);
    }
  }
  feature.hint = 0;
  if (loop.n == 0) {
    if (!centre_inside) return false;
    o.area = std::numbers::pi * radius2;
    set_least_penetration(a, b, disk.cx - a.cx, disk.cy - a.cy, o);
    return true;
  }
  const auto add_arcs = [&](Extents& extents, double nx, double ny, double n0, double t0) {
    // An arc reaches beyond the points where the disk's end along n is inside the polygon.
    for (double end : {radius, -radius}) {
      bool inside = true;
      for (int k = 0; k < polygon.n && inside; ++k) {
        const Edge e(polygon, k, disk);
        inside = e.ex * (end * ny - e.py) - e.ey * (end * nx - e.px) > 0;
      }
      if (inside) extents.include(end - n0, -t0);
    }
  };
  return contact_of_loop(a, b, loop, disk.cx - a.cx, disk.cy - a.cy,
                         arcs_of(loop, arc, radius, centre_inside), add_arcs, measures, o);
}

}  // namespace

bool overlap_of_disk_and_polygon(const PlacedShape& a, const PlacedShape& b, PairFeature& feature,
                                 Measures measures, Overlap& overlap) {
  if (a.n > kMostCorners || b.n > kMostCorners) {
    throw std::invalid_argument("a polygon has at most 64 corners");
  }
  const double dx = b.cx - a.cx, dy = b.cy - a.cy, reach = a.radius + b.radius;
  if (dx * dx + dy * dy > reach * reach) return false;
  return a.n == 0 ? overlap_of_disk_and_outline(a, b, a, b, feature, measures, overlap)
                  : overlap_of_disk_and_outline(b, a, a, b, feature, measures, overlap);
}

bool overlap_of_two_disks(const PlacedShape& a, const PlacedShape& b, Measures measures,
                          Overlap& o) {
  const double dx = b.cx - a.cx, dy = b.cy - a.cy;
  if (!overlap_of_disks<true>(dx, dy, a.radius, b.radius, o)) return false;
  o.shift_i = o.shift_j = 0;
  const double weight = measures == Measures::gradient ? 1
                        : o.chord > 0 ? weight_of_chord(a, b, o.area, o.chord * o.chord)
                                      : 0;
  if (weight == 1) {
    o.lever_i = o.arm_i;
    o.lever_j = o.arm_j;
    return true;
  }
  // One all but inside the other: s moves to the smaller one's centre.
  const double distance = std::hypot(dx, dy), small = std::min(a.radius, b.radius);
  const auto mix = [weight](double at_chord, double at_inner) {
    return weight > 0 ? at_inner + weight * (at_chord - at_inner) : at_inner;
  };
  o.lever_i = mix(o.arm_i, a.radius < b.radius ? 0 : distance);
  o.lever_j = distance - o.lever_i;
  o.length = mix(o.length, 0.25 * small);
  o.chord *= weight;
  return true;
}

}  // namespace grainfield::dem::region
