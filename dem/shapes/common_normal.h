// The contact of two superellipsoids: the direction in which they overlap least.
//
// D from the first centre to the second, h_i, h_j the support functions. The slab between the two
// tangent planes across a unit vector n has the thickness
//
//   f(n) = h_i(n) + h_j(n) - n.D
//
// (h_j(-n) = h_j(n)). f < 0 for one n proves that the bodies are apart. The depth is f where it is
// least: there the nearest points of the two surfaces, x_i and D - x_j, lie across each other by
// d n, so n is Wellmann's common normal. Across n the gradient is g = x_i + x_j - D, the Hessian
// H_i + H_j - f, of the support functions' closed forms; a pair in contact lives on one of Newton's
// steps from the normal of the step before, taken to second order in f and to first in the points.
//
// Apart, and at first touch, the least is the only one. It stays so while the radii of curvature of
// both together are above the depth in every direction. Deeper, and at edges, where a radius is 0,
// there may be others: then the remembered normal leads to the nearest. Where the least that it
// stands in ends, the normal goes over to the next one by at most kMostTurn a step, so that neither
// depth nor normal leaps.
#pragma once
#include <cstdint>
#include <limits>

#include "dem/shapes/dual_norm.h"
#include "dem/shapes/pair_step.h"
#include "dem/shapes/superellipsoid.h"

namespace grainfield::dem {

/// A normal turns by at most this in a step, rad: beyond what grains that move by a small part of
/// their size in a step can do, except round edges.
inline constexpr double kMostTurn = 0.1;

/// What a pair remembers: where it has looked last. No normal: nothing yet.
struct PairNormal {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, from the first towards the second
  std::int64_t touching = 0;                         ///< 1: they did
  /// For whom keeps account of how far bodies have turned (superellipsoid_store.h): they are apart
  /// while n.D is above this and that, m.
  double clear = std::numeric_limits<double>::infinity();
  PairPowers powers;

  bool empty() const { return normal.isZero(0); }
  /// Seen from the second.
  PairNormal reversed() const { return {-normal, touching, clear, {powers.j, powers.i}}; }
};

/// A superellipsoid and how it is turned: from the body frame to space.
struct TurnedBody {
  const Superellipsoid& shape;
  const Eigen::Matrix3d& turn;
  double farthest = 0, nearest = 0;  ///< points of the surface from the centre, m

  Tangents in_body(const Tangents& t) const {
    return {turn.transpose() * t.x, turn.transpose() * t.y};
  }
};

struct CommonNormal {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, from the first towards the second
  double depth = 0;                                  ///< m; apart: f at the normal, 0 or below
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< middle of both surfaces, from centre i, m
  /// Relative curvatures A <= B, 1/m, and the direction of A: unit. Only when asked for.
  double lesser_curvature = 0, greater_curvature = 0;
  Eigen::Vector3d major = Eigen::Vector3d::UnitX();
  int evaluations = 0;   ///< of f with its derivatives
  bool settled = false;  ///< n has come to rest
};

/// False when they are apart. `across`: D, m. Starts from the remembered normal, without one from
/// the line of centres; where the bodies overlap deeply then, also from their axes.
bool common_normal(const TurnedBody& i, const TurnedBody& j, const Eigen::Vector3d& across,
                   PairNormal& memory, CommonNormal& out, bool curvatures = false);

/// The rest of common_normal for a pair whose short steps (pair_step.h) have ended with `neither`.
bool descend_on(const TurnedBody& i, const TurnedBody& j, const Eigen::Vector3d& across,
                PairNormal& memory, CommonNormal& out);

/// `equal_radius` 0 where nobody reads it.
LaneBody lane_body(const TurnedBody& body, double equal_radius = 0);

/// f at n, m.
double thickness(const TurnedBody& i, const TurnedBody& j, const Eigen::Vector3d& across,
                 const Eigen::Vector3d& n);

}  // namespace grainfield::dem
