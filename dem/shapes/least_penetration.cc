#include <limits>

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

void set_least_penetration(const PlacedShape& a, const PlacedShape& b, const Loop& loop, double ox,
                           double oy, Overlap& overlap) {
  const double x0 = loop.x[0], y0 = loop.y[0];
  double sum = 0, mx = 0, my = 0;
  for (int i = 1; i + 1 < loop.n; ++i) {
    const double px = loop.x[i] - x0, py = loop.y[i] - y0;
    const double qx = loop.x[i + 1] - x0, qy = loop.y[i + 1] - y0;
    const double cross = px * qy - qx * py;
    sum += cross;
    mx += cross * (px + qx);
    my += cross * (py + qy);
  }
  if (sum > 0) {
    mx /= 3 * sum;
    my /= 3 * sum;
  }
  set_least_penetration(a, b, ox + x0 + mx, oy + y0 + my, overlap);
}

}  // namespace grainfield::dem::region
