// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/shapes/pair_step.h"

#include "dem/space/lane_rows.h"

#define GRAINFIELD_INLINE [[gnu::always_inline]] inline

namespace grainfield::dem {
namespace {

// A lane is a pair; its bodies come one after the other.

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
/// As Powers::OfNorm, and where they are kept.
template <int W>
struct LanePowers {
  Lanes<W> inverse_ratio, share, root;
  PairPowers* const* pairs;
  int number;  // in the order of PairPowers
  GRAINFIELD_INLINE Powers::OfNorm& kept(int k) const {
    PairPowers& p = *pairs[k];
    Powers::OfNorm* const all[]{&p.i.level, &p.i.whole, &p.j.level, &p.j.whole};
    return *all[number];
  }
};
/// As share_and_root of superellipsoid.cc.
template <int W>
GRAINFIELD_INLINE Powered<W> powered(const Lanes<W>& ratio, const Lanes<W>& power,
                                     const Lanes<W>& inverse, LanePowers<W> last) {
  Powered<W> out{};
  const auto square = power == 2;
  const auto other = power != 2;
  if (any_of(other)) {
    Lanes<W> change = ratio * last.inverse_ratio - 1;
    const auto far = other & ~(magnitude(change) * power <= kNear);
    if (any_of(far)) {
      for (int k = 0; k < W; ++k) {
        if (far[k] != 0) {
          const Powers::OfNorm at = last.kept(k) = powers_at(ratio[k], power[k]);
          last.share[k] = at.share;
          last.root[k] = at.root;
          change[k] = 0;
        }
      }
    }
    out.share = last.share * power_near_one(change, power);
    out.root = last.root * power_near_one((out.share - last.share) / (1 + last.share), inverse);
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
                                      const Lanes<W>& inverse, LanePowers<W> last) {
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

/// Lanes of a symmetric tensor in the plane, as PlaneTensor.
template <int W>
struct LaneTensor {
  Lanes<W> xx, xy, yy, determinant;
};
/// c1 u1 u1' + c2 u2 u2' of a body.
template <int W>
struct LaneBend {
  Lanes<W> weight, x, y, weight2, x2, y2, area;
};
template <int W>
GRAINFIELD_INLINE LaneTensor<W> sum_of(const LaneBend<W>& i, const LaneBend<W>& j) {
  const auto xx = [](const LaneBend<W>& b) {
    return b.weight * b.x * b.x + b.weight2 * b.x2 * b.x2;
  };
  const auto xy = [](const LaneBend<W>& b) {
    return b.weight * b.x * b.y + b.weight2 * b.x2 * b.y2;
  };
  const auto yy = [](const LaneBend<W>& b) {
    return b.weight * b.y * b.y + b.weight2 * b.y2 * b.y2;
  };
  const auto own = [](const LaneBend<W>& b, const LaneBend<W>& other) {
    const Lanes<W> mixed = b.x * other.y2 - b.y * other.x2;
    return b.weight * b.weight2 * b.area * b.area + b.weight * other.weight2 * mixed * mixed;
  };
  const Lanes<W> one = i.x * j.y - i.y * j.x, two = i.x2 * j.y2 - i.y2 * j.x2;
  const Lanes<W> both = i.weight * j.weight * one * one + i.weight2 * j.weight2 * two * two;
  return {xx(i) + xx(j), xy(i) + xy(j), yy(i) + yy(j), own(i, j) + own(j, i) + both};
}
/// Half the inverse, as of superellipsoid.cc.
template <int W>
GRAINFIELD_INLINE LaneBend<W> half_inverse(const LaneBend<W>& bend) {
  const Lanes<W> half = 0.5 / (bend.area * bend.area), floor = Lanes<W>{} + kLeastWeight;
  return {half / greater_of(bend.weight2, floor),
          -bend.y,
          bend.x,
          half / greater_of(bend.weight, floor),
          -bend.y2,
          bend.x2,
          bend.area};
}

/// As LaneBody.
template <int W>
struct LaneBodies {
  Vectors<W> turn[3], axes;
  Lanes<W> level, upright, farthest, equal_radius;
};
template <int W>
GRAINFIELD_INLINE LaneBodies<W> bodies_of(const LaneBody* const (&bodies)[kBatch],
                                          const int* slots) {
  static_assert(sizeof(LaneBody) == 16 * sizeof(double));
  const double* rows[W];
  for (int k = 0; k < W; ++k) rows[k] = bodies[slots[k]]->turn[0];
  const Four<W> a = four_of<W>(rows, 0), b = four_of<W>(rows, 4);
  const Four<W> c = four_of<W>(rows, 8), d = four_of<W>(rows, 12);
  return {{{a.a, a.b, a.c}, {a.d, b.a, b.b}, {b.c, b.d, c.a}}, {c.b, c.c, c.d}, d.a, d.b, d.c, d.d};
}

/// One body of each pair, where its outward normal is n (of the second: -n, with the same height).
template <int W>
struct Side {
  Lanes<W> height, x, y;  // of the surface's point along the tangents
  LaneBend<W> bend;
};
template <int W>
GRAINFIELD_INLINE Side<W> side_of(const LaneBodies<W>& body, const LanePowers<W>& level_powers,
                                  const LanePowers<W>& whole_powers, const Vectors<W>& n,
                                  const Vectors<W>& tx, const Vectors<W>& ty) {
  using V = Lanes<W>;
  const auto in_body = [&](const Vectors<W>& v) {
    return Vectors<W>{dot<W>(body.turn[0], v), dot<W>(body.turn[1], v), dot<W>(body.turn[2], v)};
  };
  const Vectors<W> nb = in_body(n), xb = in_body(tx), yb = in_body(ty);

  // support_of.
  const Vectors<W>& axes = body.axes;
  Vectors<W> s{magnitude(axes.x * nb.x), magnitude(axes.y * nb.y), magnitude(axes.z * nb.z)};
  const V least = kLeastShare * greater_of(greater_of(s.x, s.y), s.z);
  s = {greater_of(s.x, least), greater_of(s.y, least), greater_of(s.z, least)};
  const V &p = body.level, &q = body.upright;
  const LaneNorm<W> level = norm_of<W>(s.x, s.y, p, 1 / p, level_powers);
  const LaneNorm<W> whole = norm_of<W>(level.size, s.z, q, 1 / q, whole_powers);
  const Vectors<W> r{with_sign(axes.x, nb.x), with_sign(axes.y, nb.y), with_sign(axes.z, nb.z)};
  const V slope_x = r.x * level.pull_a, slope_y = r.y * level.pull_b;
  const V zero{};
  const Vectors<W> point{nb.x == 0 ? zero : whole.pull_a * slope_x,
                         nb.y == 0 ? zero : whole.pull_a * slope_y,
                         nb.z == 0 ? zero : whole.pull_b * r.z};
  const V level_x = r.x * level.b, level_y = -r.y * level.a;
  const Vectors<W> square{whole.b * slope_x, whole.b * slope_y, -whole.a * r.z};
  Side<W> out;
  out.height = whole.size;
  out.x = dot<W>(point, xb);
  out.y = dot<W>(point, yb);
  LaneBend<W>& bend = out.bend;
  bend.weight = whole.pull_a * level.bend / level.size;
  bend.x = level_x * xb.x + level_y * xb.y;
  bend.y = level_x * yb.x + level_y * yb.y;
  bend.weight2 = whole.bend / whole.size;
  bend.x2 = dot<W>(square, xb);
  bend.y2 = dot<W>(square, yb);
  bend.area = axes.x * axes.y * axes.z / whole.size;
  return out;
}

/// Out of line: most lanes write a row.
template <int W>
[[gnu::noinline]] void scatter(const Lanes<W>& from, const int* slots, int count, double* to) {
  for (int k = 0; k < count; ++k) to[slots[k]] = from[k];
}

/// A point along the tangents.
template <int W>
struct Pushed {
  Lanes<W> x, y;
};

// How a step ends: as Stepped, or (another) its normal is where to go on from.
enum class End { settled, apart, neither, another };

/// From the normals of the pairs in `slots`, which ascend. Of the first `count` lanes the results
/// are kept, of use where they have settled: the others repeat one of them.
template <int W>
GRAINFIELD_INLINE void step(PairBatch& batch, const int* slots, int count, bool curvatures,
                            End* ends) {
  using V = Lanes<W>;
  OverlapBatch& o = *batch.overlaps;
  const bool in_row = count == W && slots[W - 1] == slots[0] + W - 1;
  const auto of_slots = [&](const double* values) {
    if (in_row) return loaded<W>(values + slots[0]);
    return lanes_of<W>([&](int k) { return values[slots[k]]; });
  };
  const auto vectors = [&](const double(*values)[kBatch]) {
    return Vectors<W>{of_slots(values[0]), of_slots(values[1]), of_slots(values[2])};
  };
  const LaneBodies<W> first = bodies_of<W>(batch.i, slots), second = bodies_of<W>(batch.j, slots);
  PairPowers* kept[W];
  const double* rows[W];
  for (int k = 0; k < W; ++k) {
    kept[k] = batch.powers[slots[k]];
    rows[k] = &kept[k]->i.level.inverse_ratio;
  }
  static_assert(sizeof(PairPowers) == 12 * sizeof(double));
  const Four<W> p = four_of<W>(rows, 0), q = four_of<W>(rows, 4), r = four_of<W>(rows, 8);
  const LanePowers<W> level_i{p.a, p.b, p.c, kept, 0}, whole_i{p.d, q.a, q.b, kept, 1};
  const LanePowers<W> level_j{q.c, q.d, r.a, kept, 2}, whole_j{r.b, r.c, r.d, kept, 3};
  const Vectors<W> n = vectors(o.normal), across = vectors(batch.across);
  // tangents_of.
  const V unit = with_sign(V{} + 1, n.z), a = -1 / (unit + n.z), b = n.x * n.y * a;
  const Vectors<W> tx{1 + unit * n.x * n.x * a, unit * b, -unit * n.x};
  const Vectors<W> ty{b, unit + n.y * n.y * a, -n.y};
  const Side<W> i = side_of<W>(first, level_i, whole_i, n, tx, ty);
  const Side<W> j = side_of<W>(second, level_j, whole_j, n, tx, ty);

  // f, its gradient and Hessian, and the step.
  const V f = i.height + j.height - dot<W>(n, across);
  const V gx = i.x + j.x - dot<W>(across, tx), gy = i.y + j.y - dot<W>(across, ty);
  const LaneTensor<W> h = sum_of<W>(i.bend, j.bend);
  const V trace = h.xx + h.yy, divisor = h.determinant - f * trace + f * f;
  const V step_x = (f * gx - (h.yy * gx - h.xy * gy)) / divisor;
  const V step_y = (f * gy - (h.xx * gy - h.xy * gx)) / divisor;
  const V fall = -(gx * step_x + gy * step_y);
  const V reach = kPointsLeft * (first.farthest + second.farthest);
  const auto least_ahead = (f > 0) & (divisor > 0) & (trace > 2 * f) &
                           (step_x * step_x + step_y * step_y <= kShortStep * kShortStep);
  const auto settled =
      least_ahead & (fall <= kDepthLeft * f) & (gx * gx + gy * gy <= reach * reach);
  const auto another = least_ahead & (fall <= kDepthNear * f);

  Vectors<W> normal{n.x + step_x * tx.x + step_y * ty.x, n.y + step_x * tx.y + step_y * ty.y,
                    n.z + step_x * tx.z + step_y * ty.z};
  const V scale = 1 / root_of<W>(dot<W>(normal, normal));
  normal = {normal.x * scale, normal.y * scale, normal.z * scale};
  const auto put = [&](const V& from, double* to) {
    if (in_row) return store<W>(from, to + slots[0]);
    scatter<W>(from, slots, count, to);
  };
  const auto put_vector = [&](const Vectors<W>& from, double(*to)[kBatch]) {
    put(from.x, to[0]);
    put(from.y, to[1]);
    put(from.z, to[2]);
  };
  const auto goes_on = settled | another;
  put(f, batch.height);
  put_vector({goes_on ? normal.x : n.x, goes_on ? normal.y : n.y, goes_on ? normal.z : n.z},
             o.normal);
  for (int k = 0; k < count; ++k) {
    ends[k] = settled[k] != 0   ? End::settled
              : another[k] != 0 ? End::another
              : f[k] <= 0       ? End::apart
                                : End::neither;
  }
  if (!any_of(settled)) return;

  // Body i's less body j's.
  const auto on = [&](const Side<W>& side) {
    const LaneBend<W>& c = side.bend;
    const V moved = c.weight * (c.x * step_x + c.y * step_y);
    const V moved2 = c.weight2 * (c.x2 * step_x + c.y2 * step_y);
    return Pushed<W>{side.x + moved * c.x + moved2 * c.x2, side.y + moved * c.y + moved2 * c.y2};
  };
  const auto [ix, iy] = on(i);
  const auto [jx, jy] = on(j);
  const V up = i.height - j.height, beside_x = ix - jx, beside_y = iy - jy;
  const Vectors<W> middle{0.5 * (across.x + up * n.x + beside_x * tx.x + beside_y * ty.x),
                          0.5 * (across.y + up * n.y + beside_x * tx.y + beside_y * ty.y),
                          0.5 * (across.z + up * n.z + beside_x * tx.z + beside_y * ty.z)};
  const Vectors<W> back{middle.x - across.x, middle.y - across.y, middle.z - across.z};
  const V depth = f - 0.5 * fall;

  V greater{}, lesser{}, along_x{}, along_y{}, radius{};
  if (curvatures) {
    // The principal values of the sum of half the inverses.
    const LaneTensor<W> c = sum_of<W>(half_inverse<W>(i.bend), half_inverse<W>(j.bend));
    const V apart = c.xx - c.yy, root = root_of<W>(apart * apart + 4 * c.xy * c.xy);
    greater = 0.5 * (c.xx + c.yy + root);
    lesser = c.determinant / greater;
    const V straight = 0.5 * (magnitude(apart) + root);
    const V square_size = straight * straight + c.xy * c.xy;
    const V inverse_size = 1 / root_of<W>(square_size);
    const V one = square_size > 0 ? straight * inverse_size : V{} + 1;
    const V two = square_size > 0 ? c.xy * inverse_size : V{};
    along_x = apart >= 0 ? one : two;
    along_y = apart >= 0 ? two : one;
    const V &r_i = first.equal_radius, &r_j = second.equal_radius;
    radius = r_i * r_j / (r_i + r_j);
  }
  // Across the direction of the greater one.
  const Vectors<W> major{along_x * ty.x - along_y * tx.x, along_x * ty.y - along_y * tx.y,
                         along_x * ty.z - along_y * tx.z};
  put(depth, o.depth);
  put_vector(middle, o.arm_i);
  put_vector(back, o.arm_j);
  if (!curvatures) return;
  put(radius, o.radius);
  put(greater, o.greater_curvature);
  put(lesser, o.lesser_curvature);
  put_vector(major, o.major);
}

}  // namespace

template <int W>
void step_pairs_of(PairBatch& batch, bool curvatures) {
  int slots[kBatch + W], left = batch.count;
  double before[kBatch];
  for (int k = 0; k < left; ++k) slots[k] = batch.slots[k];
  for (int n = 1; n <= kMostSteps && left > 0; ++n) {
    for (int k = left; k < left + W; ++k) slots[k] = slots[left - 1];
    int again = 0;
    for (int at = 0; at < left; at += W) {
      int now[W];
      End ends[W];
      for (int k = 0; k < W; ++k) now[k] = slots[at + k];
      const int count = left - at < W ? left - at : W;
      step<W>(batch, now, count, curvatures, ends);
      for (int k = 0; k < count; ++k) {
        const int slot = now[k];
        if ((n > 1 && batch.height[slot] > before[slot]) || ends[k] == End::neither ||
            (ends[k] == End::another && n == kMostSteps)) {
          batch.ends[slot] = Stepped::neither;
        } else if (ends[k] == End::another) {
          before[slot] = batch.height[slot];
          slots[again++] = slot;
        } else {
          batch.ends[slot] = ends[k] == End::settled ? Stepped::settled : Stepped::apart;
          batch.evaluations[slot] = n;
        }
      }
    }
    left = again;
  }
}
template void step_pairs_of<GRAINFIELD_LANES>(PairBatch& batch, bool curvatures);

}  // namespace grainfield::dem
