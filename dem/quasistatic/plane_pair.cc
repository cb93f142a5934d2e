// What one pair of grains, or a grain at a wall, does: overlap, slip, force and their derivatives.
#include <algorithm>
#include <cmath>

#include "dem/quasistatic/plane_network.h"
#include "dem/shapes/polygon.h"
#include "dem/space/rotation.h"

namespace grainfield::dem {
namespace {

// Steps of the central differences, in radii: this share of the overlap's depth, over which the
// geometry is smooth, within bounds. Round-off leaves 1e-16 / step, truncation step^2 / depth^2.
constexpr double kStepShare = 1e-3, kLeastStep = 1e-9, kMostStep = 1e-6;

/// An outline's corners where they are now.
struct Corners {
  double x[kMostCorners + 1], y[kMostCorners + 1];
  int n;

  Corners(const Outline& outline, double cx, double cy, double angle)
      : n(static_cast<int>(outline.size())) {
    if (n == 0) return;
    const auto [c, s] = rotation_of(angle);
    for (int k = 0; k <= n; ++k) {
      const auto& corner = outline[k < n ? k : 0];
      x[k] = cx + (c * corner[0] - s * corner[1]);
      y[k] = cy + (s * corner[0] + c * corner[1]);
    }
  }
  PlacedShape placed(double cx, double cy, double radius) const {
    return {n > 0 ? x : nullptr, n > 0 ? y : nullptr, n, cx, cy, radius};
  }
};

}  // namespace

/// In coordinates with the first grain's centroid as origin: small numbers, no lost digits.
bool PlaneNetwork::overlap(const Pair& pair, const Place& p, Overlap& o) const {
  const Shape& a = shapes_[pair.i];
  const bool wall = pair.j < 0;
  const double wx = wall ? walls_[-1 - pair.j].normal.x() : 0;
  const double wy = wall ? walls_[-1 - pair.j].normal.y() : 0;
  const Corners first(a.outline, 0, 0, p.angle_i);
  if (wall) {
    if (-(p.dx * wx + p.dy * wy) >= a.radius) return false;
    if (!overlap_with_half_plane(first.placed(0, 0, a.radius), p.dx, p.dy, wx, wy, o, measures_)) {
      return false;
    }
    if (measures_ == Measures::gradient) o.length = a.equal_radius;
    return true;
  }
  const Shape& b = shapes_[pair.j];
  const double reach = a.radius + b.radius;
  if (p.dx * p.dx + p.dy * p.dy >= reach * reach) return false;
  const Corners second(b.outline, p.dx, p.dy, p.angle_j);
  PairFeature none;
  if (!overlap_of_shapes(first.placed(0, 0, a.radius), second.placed(p.dx, p.dy, b.radius), none, o,
                         measures_)) {
    return false;
  }
  if (measures_ == Measures::gradient) set_constant_length(a.equal_radius, b.equal_radius, o);
  return true;
}

bool PlaneNetwork::geometry(const Pair& pair, const Place& p, Geometry& g) const {
  Overlap o;
  if (!overlap(pair, p, o)) return false;
  g.normal = std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (ContactLaw<Law, 2>) {
          typename Law::template Memory<2> none;
          ContactMotion<2> at_rest;
          at_rest.inverse_mass = 1;  // any: there is no velocity to damp
          return law(o, at_rest, 0.0, 0.0, none).normal;
        }
        return 0.0;  // refused by the constructor
      },
      law_);
  g.nx = o.nx;
  g.ny = o.ny;
  g.lever_i = o.lever_i;
  g.lever_j = o.lever_j;
  g.shift_i = o.shift_i;
  g.shift_j = o.shift_j;
  if (pair.touched) {
    const double mx = pair.nx + o.nx, my = pair.ny + o.ny, m = std::hypot(mx, my);
    const double across = m > 0 ? (p.uy * mx - p.ux * my) / m : 0.0;
    g.slip = across +
             0.5 * (p.turn_i * (pair.lever_i + o.lever_i) + p.turn_j * (pair.lever_j + o.lever_j));
  } else {
    const double whole = p.uy * o.nx - p.ux * o.ny + p.turn_i * o.lever_i + p.turn_j * o.lever_j;
    const double approach = p.ux * o.nx + p.uy * o.ny - p.turn_i * o.shift_i + p.turn_j * o.shift_j;
    g.slip = approach > o.depth ? whole * o.depth / approach : whole;
  }
  return true;
}

PlaneNetwork::Force PlaneNetwork::force(const Pair& pair, const Geometry& g) const {
  Force f;
  f.normal = g.normal;
  const double limit = pair.friction * g.normal;
  f.tangential = pair.spring - tangential_stiffness_ * g.slip;
  if (std::fabs(f.tangential) >= limit) {  // without friction at 0 too
    f.tangential = std::copysign(limit, f.tangential);
    f.sticks = false;
  }
  f.fx = -f.normal * g.nx - f.tangential * g.ny;
  f.fy = -f.normal * g.ny + f.tangential * g.nx;
  f.torque_i = g.lever_i * f.tangential + g.shift_i * f.normal;
  f.torque_j = g.lever_j * f.tangential - g.shift_j * f.normal;
  return f;
}

/// Rows: f_x, f_y on i, torques on i and j; columns: by the relative position (from i to j) and the
/// two angles.
bool PlaneNetwork::slopes(const Pair& pair, const Place& at, Slopes& out) const {
  Geometry g;
  Overlap o;
  if (!overlap(pair, at, o) || !geometry(pair, at, g)) return false;
  const Force f = force(pair, g);
  const double mu = std::copysign(pair.friction, f.tangential);
  const double radius = shapes_[pair.i].radius;
  const double h = radius * std::clamp(kStepShare * o.depth / radius, kLeastStep, kMostStep);
  const bool round =
      shapes_[pair.i].outline.empty() && (pair.j < 0 || shapes_[pair.j].outline.empty());
  for (int column = 0; column < 4; ++column) {
    Geometry d;
    if (column >= 2 && round) {
      // The slip is linear in the angles, nothing else depends on them.
      const double lever = column == 2 ? g.lever_i : g.lever_j;
      const double old = column == 2 ? pair.lever_i : pair.lever_j;
      d.slip = 0.5 * (lever + old);
      if (!pair.touched) {
        const double approach = at.ux * g.nx + at.uy * g.ny;
        d.slip = approach > o.depth ? lever * o.depth / approach : lever;
      }
      if (column == 3 && pair.j < 0) d.slip = 0;
    } else if (column == 3 && pair.j < 0) {
      // A wall does not turn.
    } else {
      const double step = column < 2 ? h : h / radius;
      Geometry side[2];
      for (int s = 0; s < 2; ++s) {
        Place p = at;
        const double move = s == 0 ? -step : step;
        switch (column) {
          case 0:
            p.dx += move;
            p.ux -= move;
            break;
          case 1:
            p.dy += move;
            p.uy -= move;
            break;
          case 2:
            p.angle_i += move;
            p.turn_i += move;
            break;
          default:
            p.angle_j += move;
            p.turn_j += move;
        }
        if (!geometry(pair, p, side[s])) {
          side[s] = g;
          side[s].normal = 0;
        }
      }
      const double scale = 0.5 / step;
      d.normal = (side[1].normal - side[0].normal) * scale;
      d.slip = (side[1].slip - side[0].slip) * scale;
      d.nx = (side[1].nx - side[0].nx) * scale;
      d.ny = (side[1].ny - side[0].ny) * scale;
      d.lever_i = (side[1].lever_i - side[0].lever_i) * scale;
      d.lever_j = (side[1].lever_j - side[0].lever_j) * scale;
      d.shift_i = (side[1].shift_i - side[0].shift_i) * scale;
      d.shift_j = (side[1].shift_j - side[0].shift_j) * scale;
    }
    const double n = f.normal, t = f.tangential;
    const double dt = f.sticks ? -tangential_stiffness_ * d.slip : mu * d.normal;
    out(0, column) = -d.normal * g.nx - n * d.nx - dt * g.ny - t * d.ny;
    out(1, column) = -d.normal * g.ny - n * d.ny + dt * g.nx + t * d.nx;
    out(2, column) = d.lever_i * t + g.lever_i * dt + d.shift_i * n + g.shift_i * d.normal;
    out(3, column) = d.lever_j * t + g.lever_j * dt - d.shift_j * n - g.shift_j * d.normal;
  }
  return true;
}

}  // namespace grainfield::dem
