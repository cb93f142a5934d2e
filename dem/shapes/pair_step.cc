#include "dem/shapes/pair_step.h"

#include <cmath>

#include "dem/shapes/lanes.h"

#define GRAINFIELD_INLINE [[gnu::always_inline]] inline

namespace grainfield::dem {
namespace {

// Lanes 2k and 2k + 1 are the bodies i and j of pair k. What is of the pair stands in both.

// A step is short, rad, and another one may follow where it would change the depth by no more than
// this share of it: there each step squares what the last one has left.
constexpr double kShortStep = 0.03, kDepthNear = 1e-2;
constexpr int kMostSteps = 3;

template <int W>
struct Vectors {
  Lanes<W> x, y, z;
};
template <int W>
GRAINFIELD_INLINE Lanes<W> dot(const Vectors<W>& a, const Vectors<W>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <int W>
struct Powered {
  Lanes<W> share, root;
};
/// As share_and_root of superellipsoid.cc.
template <int W>
GRAINFIELD_INLINE Powered<W> powered(const Lanes<W>& ratio, const Lanes<W>& power,
                                     const Lanes<W>& inverse, Powers::OfNorm* const* last) {
  Powered<W> out{};
  const auto square = power == 2;
  const auto other = power != 2;
  if (any_of(other)) {
    Lanes<W> change = ratio * lanes_of<W>([&](int k) { return last[k]->inverse_ratio; }) - 1;
    const auto far = other & ~(magnitude(change) * power <= kNear);
    if (any_of(far)) {
      for (int k = 0; k < W; ++k) {
        if (far[k] != 0) {
          *last[k] = powers_at(ratio[k], power[k]);
          change[k] = 0;
        }
      }
    }
    const Lanes<W> share = lanes_of<W>([&](int k) { return last[k]->share; });
    const Lanes<W> root = lanes_of<W>([&](int k) { return last[k]->root; });
    out.share = share * power_near_one(change, power);
    out.root = root * power_near_one((out.share - share) / (1 + share), inverse);
  }
  if (any_of(square)) {
    const Lanes<W> share = ratio * ratio, root = root_of<W>(1 + share);
    out.share = square ? share : out.share;
    out.root = square ? root : out.root;
  }
  return out;
}

/// As Norm of superellipsoid.cc.
template <int W>
struct LaneNorm {
  Lanes<W> size, a, b, pull_a, pull_b, bend;
};
template <int W>
GRAINFIELD_INLINE LaneNorm<W> norm_of(const Lanes<W>& a, const Lanes<W>& b, const Lanes<W>& power,
                                      const Lanes<W>& inverse, Powers::OfNorm* const* last) {
  const auto turned = b > a;
  const Lanes<W> most = turned ? b : a, least = turned ? a : b, ratio = least / most;
  const auto [share, root] = powered<W>(ratio, power, inverse, last);
  const Lanes<W> part = 1 / root, rest = ratio * part, inverse_ratio = most / least;
  const Lanes<W> pull_most = root / (1 + share), pull_least = share * inverse_ratio * pull_most;
  LaneNorm<W> out;
  out.size = most * root;
  out.bend = (power - 1) * pull_most * pull_least * (root * root * inverse_ratio);
  out.a = turned ? rest : part;
  out.b = turned ? part : rest;
  out.pull_a = turned ? pull_least : pull_most;
  out.pull_b = turned ? pull_most : pull_least;
  return out;
}

/// Of a symmetric tensor in the plane, as PlaneTensor.
template <int W>
struct LaneTensor {
  Lanes<W> xx, xy, yy, determinant;
};
/// c1 u1 u1' + c2 u2 u2' of each body.
template <int W>
struct LaneBend {
  Lanes<W> weight, x, y, weight2, x2, y2, area;
};
template <int W>
GRAINFIELD_INLINE LaneTensor<W> sum_of(const LaneBend<W>& b) {
  const Lanes<W> xx = b.weight * b.x * b.x + b.weight2 * b.x2 * b.x2;
  const Lanes<W> xy = b.weight * b.x * b.y + b.weight2 * b.x2 * b.y2;
  const Lanes<W> yy = b.weight * b.y * b.y + b.weight2 * b.y2 * b.y2;
  const Lanes<W> sx = swapped<W>(b.x), sy = swapped<W>(b.y);
  const Lanes<W> sx2 = swapped<W>(b.x2), sy2 = swapped<W>(b.y2);
  const Lanes<W> one = b.x * sy - b.y * sx, two = b.x2 * sy2 - b.y2 * sx2;
  const Lanes<W> mixed = b.x * sy2 - b.y * sx2;
  const Lanes<W> own =
      b.weight * b.weight2 * b.area * b.area + b.weight * swapped<W>(b.weight2) * mixed * mixed;
  const Lanes<W> both =
      b.weight * swapped<W>(b.weight) * one * one + b.weight2 * swapped<W>(b.weight2) * two * two;
  return {xx + swapped<W>(xx), xy + swapped<W>(xy), yy + swapped<W>(yy),
          own + swapped<W>(own) + both};
}

/// From the normals `from`, by pair. How each ends: as Stepped, or (another) its normal is where to
/// go on from.
enum class End { settled, apart, neither, another };
template <int W>
GRAINFIELD_INLINE void step(const PairStep* pairs, const Eigen::Vector3d* from, bool curvatures,
                            End* ends) {
  using V = Lanes<W>;
  const TurnedBody* bodies[W];
  Powers::OfNorm *level_powers[W], *whole_powers[W];
  for (int k = 0; k < W; ++k) {
    const PairStep& p = pairs[k / 2];
    bodies[k] = k % 2 == 0 ? p.i : p.j;
    Powers& powers = k % 2 == 0 ? p.memory->powers_i : p.memory->powers_j;
    level_powers[k] = &powers.level;
    whole_powers[k] = &powers.whole;
  }
  const auto of_pairs = [&](auto get) {
    return lanes_of<W>([&](int k) { return get(pairs[k / 2]); });
  };
  const auto of_bodies = [&](auto get) {
    return lanes_of<W>([&](int k) { return get(*bodies[k]); });
  };
  const Vectors<W> n{lanes_of<W>([&](int k) { return from[k / 2].x(); }),
                     lanes_of<W>([&](int k) { return from[k / 2].y(); }),
                     lanes_of<W>([&](int k) { return from[k / 2].z(); })};
  const Vectors<W> across{of_pairs([](const PairStep& p) { return p.across.x(); }),
                          of_pairs([](const PairStep& p) { return p.across.y(); }),
                          of_pairs([](const PairStep& p) { return p.across.z(); })};
  // tangents_of.
  const V unit = with_sign(V{} + 1, n.z), a = -1 / (unit + n.z), b = n.x * n.y * a;
  const Vectors<W> tx{1 + unit * n.x * n.x * a, unit * b, -unit * n.x};
  const Vectors<W> ty{b, unit + n.y * n.y * a, -n.y};
  const auto column = [&](int axis) {
    return Vectors<W>{of_bodies([axis](const TurnedBody& t) { return t.turn(0, axis); }),
                      of_bodies([axis](const TurnedBody& t) { return t.turn(1, axis); }),
                      of_bodies([axis](const TurnedBody& t) { return t.turn(2, axis); })};
  };
  const Vectors<W> c0 = column(0), c1 = column(1), c2 = column(2);
  const Vectors<W> nb{dot<W>(c0, n), dot<W>(c1, n), dot<W>(c2, n)};
  const Vectors<W> xb{dot<W>(c0, tx), dot<W>(c1, tx), dot<W>(c2, tx)};
  const Vectors<W> yb{dot<W>(c0, ty), dot<W>(c1, ty), dot<W>(c2, ty)};

  // support_of.
  const Vectors<W> axes{of_bodies([](const TurnedBody& t) { return t.shape.axes.x(); }),
                        of_bodies([](const TurnedBody& t) { return t.shape.axes.y(); }),
                        of_bodies([](const TurnedBody& t) { return t.shape.axes.z(); })};
  Vectors<W> s{magnitude(axes.x * nb.x), magnitude(axes.y * nb.y), magnitude(axes.z * nb.z)};
  const V least = kLeastShare * greater_of(greater_of(s.x, s.y), s.z);
  s = {greater_of(s.x, least), greater_of(s.y, least), greater_of(s.z, least)};
  const V p = of_bodies([](const TurnedBody& t) { return t.shape.level; });
  const V q = of_bodies([](const TurnedBody& t) { return t.shape.upright; });
  const LaneNorm<W> level = norm_of<W>(s.x, s.y, p, 1 / p, level_powers);
  const LaneNorm<W> whole = norm_of<W>(level.size, s.z, q, 1 / q, whole_powers);
  const Vectors<W> r{with_sign(axes.x, nb.x), with_sign(axes.y, nb.y), with_sign(axes.z, nb.z)};
  const V slope_x = r.x * level.pull_a, slope_y = r.y * level.pull_b;
  const V zero{};
  const Vectors<W> point{nb.x == 0 ? zero : whole.pull_a * slope_x,
                         nb.y == 0 ? zero : whole.pull_a * slope_y,
                         nb.z == 0 ? zero : whole.pull_b * r.z};
  LaneBend<W> bend;
  const V level_x = r.x * level.b, level_y = -r.y * level.a;
  const Vectors<W> square{whole.b * slope_x, whole.b * slope_y, -whole.a * r.z};
  bend.weight = whole.pull_a * level.bend / level.size;
  bend.x = level_x * xb.x + level_y * xb.y;
  bend.y = level_x * yb.x + level_y * yb.y;
  bend.weight2 = whole.bend / whole.size;
  bend.x2 = dot<W>(square, xb);
  bend.y2 = dot<W>(square, yb);
  bend.area = axes.x * axes.y * axes.z / whole.size;

  // f, its gradient and Hessian, and the step.
  const V f = whole.size + swapped<W>(whole.size) - dot<W>(n, across);
  const V px = dot<W>(point, xb), py = dot<W>(point, yb);
  const V gx = px + swapped<W>(px) - dot<W>(across, tx);
  const V gy = py + swapped<W>(py) - dot<W>(across, ty);
  const LaneTensor<W> h = sum_of<W>(bend);
  const V trace = h.xx + h.yy, divisor = h.determinant - f * trace + f * f;
  const V step_x = (f * gx - (h.yy * gx - h.xy * gy)) / divisor;
  const V step_y = (f * gy - (h.xx * gy - h.xy * gx)) / divisor;
  const V fall = -(gx * step_x + gy * step_y);
  const V size = of_bodies([](const TurnedBody& t) { return t.farthest; });
  const V reach = kPointsLeft * (size + swapped<W>(size));
  const auto least_ahead = (f > 0) & (divisor > 0) & (trace > 2 * f) &
                           (step_x * step_x + step_y * step_y <= kShortStep * kShortStep);
  const auto settled =
      least_ahead & (fall <= kDepthLeft * f) & (gx * gx + gy * gy <= reach * reach);
  const auto another = least_ahead & (fall <= kDepthNear * f);

  const V moved = bend.weight * (bend.x * step_x + bend.y * step_y);
  const V moved2 = bend.weight2 * (bend.x2 * step_x + bend.y2 * step_y);
  const V on_x = px + moved * bend.x + moved2 * bend.x2;
  const V on_y = py + moved * bend.y + moved2 * bend.y2;
  // Of body i less that of j: of the first of two lanes.
  const V up = whole.size - swapped<W>(whole.size);
  const V beside_x = on_x - swapped<W>(on_x), beside_y = on_y - swapped<W>(on_y);
  const Vectors<W> middle{0.5 * (across.x + up * n.x + beside_x * tx.x + beside_y * ty.x),
                          0.5 * (across.y + up * n.y + beside_x * tx.y + beside_y * ty.y),
                          0.5 * (across.z + up * n.z + beside_x * tx.z + beside_y * ty.z)};
  Vectors<W> normal{n.x + step_x * tx.x + step_y * ty.x, n.y + step_x * tx.y + step_y * ty.y,
                    n.z + step_x * tx.z + step_y * ty.z};
  const V scale = 1 / root_of<W>(dot<W>(normal, normal));
  normal = {normal.x * scale, normal.y * scale, normal.z * scale};
  const V depth = f - 0.5 * fall;

  V greater = zero, lesser = zero, along_x = zero, along_y = zero;
  if (curvatures) {
    // Half the inverse of each, and the principal values of their sum.
    const V half = 0.5 / (bend.area * bend.area);
    const V floor = V{} + kLeastWeight;
    const LaneBend<W> inverse{half / greater_of(bend.weight2, floor),
                              -bend.y,
                              bend.x,
                              half / greater_of(bend.weight, floor),
                              -bend.y2,
                              bend.x2,
                              bend.area};
    const LaneTensor<W> c = sum_of<W>(inverse);
    const V apart = c.xx - c.yy, root = root_of<W>(apart * apart + 4 * c.xy * c.xy);
    greater = 0.5 * (c.xx + c.yy + root);
    lesser = c.determinant / greater;
    const V straight = 0.5 * (magnitude(apart) + root);
    const V square_size = straight * straight + c.xy * c.xy;
    const V inverse_size = 1 / root_of<W>(square_size);
    const V one = square_size > 0 ? straight * inverse_size : V{} + 1;
    const V two = square_size > 0 ? c.xy * inverse_size : zero;
    along_x = apart >= 0 ? one : two;
    along_y = apart >= 0 ? two : one;
  }
  for (int k = 0; k < W; k += 2) {
    const PairStep& pair = pairs[k / 2];
    CommonNormal& out = *pair.out;
    out.depth = f[k];
    ends[k / 2] = f[k] <= 0 ? End::apart : another[k] != 0 ? End::another : End::neither;
    if (settled[k] != 0) ends[k / 2] = End::settled;
    if (ends[k / 2] == End::neither || ends[k / 2] == End::apart) continue;
    out.normal = {normal.x[k], normal.y[k], normal.z[k]};
    if (ends[k / 2] == End::another) continue;
    out.depth = depth[k];
    out.point = {middle.x[k], middle.y[k], middle.z[k]};
    out.greater_curvature = greater[k];
    out.lesser_curvature = lesser[k];
    // Across the direction of the greater one.
    const double u = along_x[k], v = along_y[k];
    out.major = {u * ty.x[k] - v * tx.x[k], u * ty.y[k] - v * tx.y[k], u * ty.z[k] - v * tx.z[k]};
  }
}

}  // namespace

Stepped step_pair(PairStep pair, bool curvatures) {
  Eigen::Vector3d from = pair.memory->normal;
  double before = 0;
  for (int n = 1; n <= kMostSteps; ++n) {
    End end = End::neither;
    step<2>(&pair, &from, curvatures, &end);
    CommonNormal& out = *pair.out;
    if (n > 1 && out.depth > before) return Stepped::neither;
    if (end == End::settled) {
      out.settled = true;
      out.evaluations = n;
      pair.memory->normal = out.normal;
      return Stepped::settled;
    }
    if (end == End::apart) {
      pair.memory->normal = from;
      return Stepped::apart;
    }
    if (end == End::neither) return Stepped::neither;
    from = out.normal;
    before = out.depth;
  }
  return Stepped::neither;
}

}  // namespace grainfield::dem
