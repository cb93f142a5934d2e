// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/shapes/crossing_lanes.h"

#include "dem/shapes/pair_memory.h"
#include "dem/space/lane_rows.h"

#define GRAINFIELD_INLINE [[gnu::always_inline]] inline

namespace grainfield::dem {
namespace {

using Bits = std::uint64_t;

/// A body's corners where they are, n + 1 of them.
struct Corners {
  const double *x, *y;
  int n;
};
GRAINFIELD_INLINE Corners corners_of(const CrossingRows& rows, int i) {
  const double* block = rows.blocks + static_cast<std::size_t>(i) * rows.block_size;
  return {block + 2 * rows.stride, block + 3 * rows.stride, rows.corners[i]};
}

// Corners or edges of one outline side by side, C at a time. Bit k of a result is of the k-th.
// `stride`: of the blocks, where it is known before; or 0, for any. Of blocks longer than kShort
// with a known stride the numbers from kShort on repeat the first corner at most.
constexpr int kShort = 8;
constexpr int looked_at(int stride) { return stride < kShort ? stride : kShort; }

GRAINFIELD_INLINE bool has_first(Bits bits, int n) { return (~bits & (~Bits{0} >> (64 - n))) == 0; }

/// As separates (polygon_overlap.cc), of edge k of `shape`.
template <int C, int stride>
GRAINFIELD_INLINE bool separates(const Corners& shape, int k, const Corners& other) {
  const double px = shape.x[k], py = shape.y[k];
  const double ex = shape.x[k + 1] - px, ey = shape.y[k + 1] - py;
  Bits outside = 0;
  for (int at = 0; at < (stride > 0 ? looked_at(stride) : other.n); at += C) {
    const Lanes<C> x = loaded<C>(other.x + at), y = loaded<C>(other.y + at);
    outside |= unsigned_bits<C>(ey * (x - px) - ex * (y - py)) << at;
  }
  return has_first(outside, other.n);
}

/// Both points are inside of all edges: inside_of_all.
template <int C, int stride>
GRAINFIELD_INLINE bool are_inside(const Corners& shape, int size, double x1, double y1, double x2,
                                  double y2) {
  Bits in = 0;
  for (int at = 0; at < (stride > 0 ? looked_at(stride) : shape.n); at += C) {
    const Lanes<C> px = loaded<C>(shape.x + at), py = loaded<C>(shape.y + at);
    Lanes<C> ex, ey;
    if (at + C < (stride > 0 ? stride : size)) {
      ex = loaded<C>(shape.x + at + 1) - px;
      ey = loaded<C>(shape.y + at + 1) - py;
    } else {  // there is nothing behind the block; the last lane is no edge
      ex = next_lanes<C>(px) - px;
      ey = next_lanes<C>(py) - py;
    }
    in |= (positive_bits<C>(ex * (y1 - py) - ey * (x1 - px)) &
           positive_bits<C>(ex * (y2 - py) - ey * (x2 - px)))
          << at;
  }
  return has_first(in, shape.n);
}

/// Pairs that may cross where they did, by position: corners ea, ea + 1, la, la + 1 of A and
/// eb, eb + 1, lb, lb + 1 of B (Crossings in polygon_overlap.cc), and how many of them are inside
/// the other: of A behind ea up to la, of B behind eb up to lb, each not more than two.
struct alignas(64) Crossing {
  double x[kBatch][8], y[kBatch][8];
  double inner_a[kBatch], inner_b[kBatch];
  const double *body_i[kBatch], *body_j[kBatch];
};

struct Edges {
  int ea, la, eb, lb;
};
GRAINFIELD_INLINE void put_corners(const Corners& a, const Corners& b, const Edges& e, double* x,
                                   double* y) {
  const auto put = [&](const double* from_a, const double* from_b, double* to) {
    to[0] = from_a[e.ea];
    to[1] = from_a[e.ea + 1];
    to[2] = from_a[e.la];
    to[3] = from_a[e.la + 1];
    to[4] = from_b[e.eb];
    to[5] = from_b[e.eb + 1];
    to[6] = from_b[e.lb];
    to[7] = from_b[e.lb + 1];
  };
  put(a.x, b.x, x);
  put(a.y, b.y, y);
}
#if defined(__AVX512F__)
/// The same of outlines of up to kShort corners, picked from two vectors.
GRAINFIELD_INLINE void put_corners_of_8(const Corners& a, const Corners& b, std::uint32_t hint,
                                        double* x, double* y) {
  const __m512i shift = _mm512_set_epi64(18, 18, 12, 12, 6, 6, 0, 0);
  const __m512i more = _mm512_set_epi64(1, 0, 1, 0, 1, 0, 1, 0);
  const __m512i of_b = _mm512_set_epi64(8, 8, 8, 8, 0, 0, 0, 0);
  const __m512i edges =
      _mm512_maskz_srlv_epi64(0xFF, _mm512_set1_epi64(static_cast<long long>(hint)), shift);
  // Behind the eighth corner comes the first one.
  const __m512i which = _mm512_or_epi64(
      _mm512_and_epi64(_mm512_add_epi64(_mm512_and_epi64(edges, _mm512_set1_epi64(63)), more),
                       _mm512_set1_epi64(7)),
      of_b);
  _mm512_storeu_pd(x, _mm512_permutex2var_pd(_mm512_loadu_pd(a.x), which, _mm512_loadu_pd(b.x)));
  _mm512_storeu_pd(y, _mm512_permutex2var_pd(_mm512_loadu_pd(a.y), which, _mm512_loadu_pd(b.y)));
}
#endif

/// Corners of `e` behind the first up to the last.
GRAINFIELD_INLINE int between(int first, int last, int n) {
  const int count = last - first;
  return count < 0 ? count + n : count;
}

/// True when, for all that corners beside the edges say, the two cross there.
template <int C, int stride>
GRAINFIELD_INLINE bool may_cross(const Corners& a, const Corners& b, int size, std::uint32_t hint,
                                 Crossing& c, int at) {
  const Edges e{static_cast<int>(hint & 63u), static_cast<int>(hint >> 6 & 63u),
                static_cast<int>(hint >> 12 & 63u), static_cast<int>(hint >> 18 & 63u)};
  if (!((e.ea < a.n) & (e.la < a.n) & (e.eb < b.n) & (e.lb < b.n))) return false;
  const int inner_a = between(e.ea, e.la, a.n), inner_b = between(e.eb, e.lb, b.n);
  if ((inner_a > 2) | (inner_b > 2)) return false;
  // Both are the same for one that is inside.
  const bool a_in =
      are_inside<C, stride>(b, size, a.x[e.ea + 1], a.y[e.ea + 1], a.x[e.la], a.y[e.la]);
  const bool b_in =
      are_inside<C, stride>(a, size, b.x[e.eb + 1], b.y[e.eb + 1], b.x[e.lb], b.y[e.lb]);
  if (!((a_in | (inner_a == 0)) & (b_in | (inner_b == 0)))) return false;
  c.inner_a[at] = inner_a;
  c.inner_b[at] = inner_b;
#if defined(__AVX512F__)
  if constexpr (stride > 0) {
    put_corners_of_8(a, b, hint, c.x[at], c.y[at]);
    return true;
  }
#endif
  put_corners(a, b, e, c.x[at], c.y[at]);
  return true;
}

/// A point of each lane.
template <int W>
struct Point {
  Lanes<W> x, y;
};
template <int W>
GRAINFIELD_INLINE Lanes<W> cross(const Point<W>& a, const Point<W>& b) {
  return a.x * b.y - b.x * a.y;
}
/// inside_of.
template <int W>
GRAINFIELD_INLINE Lanes<W> inside(const Point<W>& from, const Point<W>& to, const Point<W>& p) {
  return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
}

/// The rest of contact_of_crossings, of positions at to at + W - 1; those of them that do not cross
/// for sure are not among `sure`.
template <int W>
GRAINFIELD_INLINE auto overlap(const Crossing& c, int at, int count, PlaneOverlapBatch& o) {
  using V = Lanes<W>;
  const V none{};
  const double *x[W], *y[W], *body_i[W], *body_j[W];
  for (int k = 0; k < W; ++k) {
    const int place = at + k < count ? at + k : at;
    x[k] = c.x[place];
    y[k] = c.y[place];
    body_i[k] = c.body_i[place];
    body_j[k] = c.body_j[place];
  }
  const Four<W> xa = four_of<W>(x, 0), xb = four_of<W>(x, 4);
  const Four<W> ya = four_of<W>(y, 0), yb = four_of<W>(y, 4);
  const Point<W> a0{xa.a, ya.a}, a1{xa.b, ya.b}, a2{xa.c, ya.c}, a3{xa.d, ya.d};
  const Point<W> b0{xb.a, yb.a}, b1{xb.b, yb.b}, b2{xb.c, yb.c}, b3{xb.d, yb.d};
  const V out1 = inside<W>(b2, b3, a0), in1 = inside<W>(b2, b3, a1);
  const V in2 = inside<W>(b0, b1, a2), out2 = inside<W>(b0, b1, a3);
  auto sure = (out1 < 0) & (in1 > 0) & (in2 > 0) & (out2 < 0) & (inside<W>(a0, a1, b2) > 0) &
              (inside<W>(a0, a1, b3) < 0) & (inside<W>(a2, a3, b0) < 0) &
              (inside<W>(a2, a3, b1) > 0);

  const auto column = [](const double* const* bodies, int number) {
    return lanes_of<W>([&](int k) { return bodies[k][number]; });
  };
  const Point<W> ci{column(body_i, 0), column(body_i, 1)}, cj{column(body_j, 0), column(body_j, 1)};
  const V radius_i = column(body_i, 5), radius_j = column(body_j, 5);
  const V t1 = in1 / (in1 - out1), t2 = in2 / (in2 - out2);
  const Point<W> p1{(a1.x - ci.x) + t1 * (a0.x - a1.x), (a1.y - ci.y) + t1 * (a0.y - a1.y)};
  const Point<W> p2{(a2.x - ci.x) + t2 * (a3.x - a2.x), (a2.y - ci.y) + t2 * (a3.y - a2.y)};
  const Point<W> chord{p2.x - p1.x, p2.y - p1.y};
  // What one that is inside and the same one once more add is 0.
  const auto any_a = loaded<W>(c.inner_a + at) > 0, any_b = loaded<W>(c.inner_b + at) > 0;
  const auto from_p1 = [&](const Point<W>& p) {
    return Point<W>{(p.x - ci.x) - p1.x, (p.y - ci.y) - p1.y};
  };
  const Point<W> u = from_p1(a1), v = from_p1(a2), w = from_p1(b1), z = from_p1(b2);
  V twice = any_a ? cross<W>(u, v) + cross<W>(v, chord) : none;
  twice += any_b ? cross<W>(chord, w) : none;
  twice += any_b ? cross<W>(w, z) : none;
  const V squared = chord.x * chord.x + chord.y * chord.y, reach = radius_i + radius_j;
  const V area = 0.5 * twice, least = kSureArea * reach * reach;
  const V radius = radius_j < radius_i ? radius_j : radius_i;
  sure &= (area > least) & (squared > least) & (squared >= kLastPart * area) &
          (area <= (1 - kLastPart) * kLeastArea * radius * radius);

  const V length = root_of<W>(squared), inverse = 1 / length;
  const V nx = chord.y * inverse, ny = -chord.x * inverse;
  // set_contact_point.
  const Point<W> si{p1.x + 0.5 * chord.x, p1.y + 0.5 * chord.y};
  const Point<W> sj{si.x - (cj.x - ci.x), si.y - (cj.y - ci.y)};
  const V arm_i = root_of<W>(si.x * si.x + si.y * si.y);
  const V arm_j = root_of<W>(sj.x * sj.x + sj.y * sj.y);
  sure &= (arm_i >= kShortArm * radius_i) & (arm_j >= kShortArm * radius_j);
  store<W>(nx, o.nx + at);
  store<W>(ny, o.ny + at);
  store<W>(area, o.area + at);
  store<W>(length, o.chord + at);
  store<W>(arm_i * arm_j / (arm_i + arm_j), o.length + at);
  store<W>(arm_i, o.arm_i + at);
  store<W>(arm_j, o.arm_j + at);
  store<W>(si.x * nx + si.y * ny, o.lever_i + at);
  store<W>(si.y * nx - si.x * ny, o.shift_i + at);
  store<W>(-(sj.x * nx + sj.y * ny), o.lever_j + at);
  store<W>(sj.y * nx - sj.x * ny, o.shift_j + at);
  return sure;
}

/// The pairs of a batch by what they remember, in their order.
struct Sorted {
  int separated = 0, crossed = 0;
  int of_separated[kBatch], of_crossed[kBatch];
  int j[kBatch];
  std::uint32_t hint[kBatch];
};
GRAINFIELD_INLINE void sort(const CrossingRows& rows, const RowBatch& batch, Sorted& s,
                            PairFate* state) {
  for (int slot = 0; slot < batch.count; ++slot) {
    const unsigned char* pair = rows.pairs + std::ptrdiff_t{batch.pair[slot]} * kPlanePair;
    std::uint32_t hint = 0;
    const int j = batch.second[slot];
    __builtin_memcpy(&hint, pair + kFeatureInPair, sizeof hint);
    const int i = batch.first[slot];
    const double* a = rows.bodies + std::ptrdiff_t{i} * kPlaneBody;
    const double* b = rows.bodies + std::ptrdiff_t{j} * kPlaneBody;
    const double dx = b[0] - a[0], dy = b[1] - a[1], reach = a[5] + b[5];
    const bool far = dx * dx + dy * dy >= reach * reach;
    const bool polygons = (rows.corners[i] > 0) & (rows.corners[j] > 0) & !far;
    s.j[slot] = j;
    s.hint[slot] = hint;
    s.of_separated[s.separated] = slot;
    s.separated += polygons & (hint - 1 < kMostHint);
    s.of_crossed[s.crossed] = slot;
    s.crossed += polygons & ((hint >> 24) == (kCrossed >> 24));
    state[slot] = far ? PairFate::apart : PairFate::left;
  }
}

template <int W, int C, int stride>
GRAINFIELD_INLINE void overlaps_by(const CrossingRows& rows, const RowBatch& batch,
                                   PlaneOverlapBatch& o) {
  Sorted s;
  sort(rows, batch, s, o.state);
  for (int n = 0; n < s.separated; ++n) {
    const int slot = s.of_separated[n];
    const std::uint32_t edge = (s.hint[slot] - 1) / 2, of_b = (s.hint[slot] - 1) & 1u;
    const int i = batch.first[slot], j = s.j[slot];
    const Corners shape = corners_of(rows, of_b != 0 ? j : i);
    const Corners other = corners_of(rows, of_b != 0 ? i : j);
    if (edge >= static_cast<std::uint32_t>(shape.n)) continue;
    const bool apart = separates<C, stride>(shape, static_cast<int>(edge), other);
    if (apart) [[likely]]
      o.state[slot] = PairFate::apart;
  }
  Crossing c;
  int count = 0;
  for (int n = 0; n < s.crossed; ++n) {
    const int slot = s.of_crossed[n], i = batch.first[slot], j = s.j[slot];
    c.body_i[count] = rows.bodies + std::ptrdiff_t{i} * kPlaneBody;
    c.body_j[count] = rows.bodies + std::ptrdiff_t{j} * kPlaneBody;
    o.slot[count] = slot;
    o.place[slot] = count;
    const Corners a = corners_of(rows, i), b = corners_of(rows, j);
    const bool may = may_cross<C, stride>(a, b, rows.stride, s.hint[slot], c, count);
    if (may) [[likely]]
      ++count;
  }
  o.count = count;
  for (int at = 0; at < count; at += W) {
    const Bits sure = bits_of(overlap<W>(c, at, count, o));
    for (int k = 0; k < W && at + k < count; ++k) {
      if ((sure >> k & 1u) != 0) o.state[o.slot[at + k]] = PairFate::touches;
    }
  }
}

}  // namespace

template <int W>
void crossing_overlaps_of(const CrossingRows& rows, const RowBatch& batch, PlaneOverlapBatch& o) {
  constexpr int few = W < 4 ? W : 4;
  if (rows.stride == 8) return overlaps_by<W, W, 8>(rows, batch, o);  // up to seven corners
  if (rows.stride == 12 && rows.most_corners <= kShort) {
    return overlaps_by<W, W, 12>(rows, batch, o);
  }
  overlaps_by<W, few, 0>(rows, batch, o);
}
template void crossing_overlaps_of<GRAINFIELD_LANES>(const CrossingRows& rows,
                                                     const RowBatch& batch,
                                                     PlaneOverlapBatch& overlaps);

}  // namespace grainfield::dem
