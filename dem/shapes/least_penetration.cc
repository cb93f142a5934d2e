#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "dem/shapes/overlap_region.h"

namespace grainfield::dem::region {

namespace {

// Largest extent of a shape along the unit vector (ux, uy), measured from (ox, oy).
double extent(const PlacedShape& shape, double ux, double uy, double ox, double oy) {
  if (shape.n == 0) return (shape.cx - ox) * ux + (shape.cy - oy) * uy + shape.radius;
  double most = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < shape.n; ++k) {
    most = std::fmax(most, (shape.x[k] - ox) * ux + (shape.y[k] - oy) * uy);
  }
  return most;
}

// The least displacement found so far.
struct Least {
  const PlacedShape& a;
  const PlacedShape& b;
  double nx = 1, ny = 0, depth = std::numeric_limits<double>::infinity();

  // Along the unit vector (ux, uy), from A to B.
  void try_direction(double ux, double uy) {
    const double d = extent(a, ux, uy, a.cx, a.cy) + extent(b, -ux, -uy, a.cx, a.cy);
    if (d < depth) {
      depth = d;
      nx = ux;
      ny = uy;
    }
  }
  // Along the normals of the edges: out of A (sign 1), into B (sign -1).
  void try_edges(const PlacedShape& shape, double sign) {
    for (int k = 0; k < shape.n; ++k) {
      const double ex = shape.x[k + 1] - shape.x[k], ey = shape.y[k + 1] - shape.y[k];
      const double scale = sign / std::sqrt(ex * ex + ey * ey);
      try_direction(scale * ey, -scale * ex);
    }
  }
};

}  // namespace

void set_least_penetration(const PlacedShape& a, const PlacedShape& b, double mx, double my,
                           Overlap& overlap) {
  Least least{a, b};
  if (a.n == 0 || b.n == 0) {
    const double dx = b.cx - a.cx, dy = b.cy - a.cy, distance = std::hypot(dx, dy);
    if (distance > 0) least.try_direction(dx / distance, dy / distance);
  }
  least.try_edges(a, 1);
  least.try_edges(b, -1);
  overlap.nx = least.nx;
  overlap.ny = least.ny;
  overlap.depth = least.depth;
  overlap.chord = 0;
  set_contact_point(a, b, mx, my, overlap);
}

double area_of(const PlacedShape& shape) {
  if (shape.n == 0) return std::numbers::pi * shape.radius * shape.radius;
  double twice = 0;
  for (int k = 0; k < shape.n; ++k) {
    twice += (shape.x[k] - shape.cx) * (shape.y[k + 1] - shape.cy) -
             (shape.x[k + 1] - shape.cx) * (shape.y[k] - shape.cy);
  }
  return 0.5 * twice;
}

void hand_over(const PlacedShape& a, const PlacedShape& b, const Loop& loop, const Arcs& arcs,
               double ox, double oy, double weight, Overlap& o) {
  // The region's middle, from the loop's first point.
  const double x0 = loop.x[0], y0 = loop.y[0];
  double area = arcs.area, mx = arcs.mx - x0 * arcs.area, my = arcs.my - y0 * arcs.area;
  for (int i = 1; i + 1 < loop.n; ++i) {
    const double px = loop.x[i] - x0, py = loop.y[i] - y0;
    const double qx = loop.x[i + 1] - x0, qy = loop.y[i + 1] - y0;
    const double cross = px * qy - qx * py;
    area += cross / 2;
    mx += cross * (px + qx) / 6;
    my += cross * (py + qy) / 6;
  }
  if (area > 0) {
    mx /= area;
    my /= area;
  }
  Overlap inner;
  set_least_penetration(a, b, ox + x0 + mx, oy + y0 + my, inner);
  if (weight > 0) {
    const auto mix = [weight](double at_chord, double at_inner) {
      return at_inner + weight * (at_chord - at_inner);
    };
    const auto point = [](const Overlap& p) {
      return std::array{p.lever_i * p.nx - p.shift_i * p.ny, p.lever_i * p.ny + p.shift_i * p.nx};
    };
    const auto [sx, sy] = point(o);
    const auto [tx, ty] = point(inner);
    const double nx = mix(o.nx, inner.nx), ny = mix(o.ny, inner.ny);
    const double size = std::max(std::hypot(nx, ny), 1e-12);
    inner.nx = nx / size;
    inner.ny = ny / size;
    inner.depth = mix(o.depth, inner.depth);
    set_contact_point(a, b, mix(sx, tx), mix(sy, ty), inner);
    // Where one normal turns into its opposite the force passes through 0.
    inner.length /= size;
    inner.chord = weight * size * o.chord;
  }
  inner.area = o.area;
  o = inner;
}

}  // namespace grainfield::dem::region
