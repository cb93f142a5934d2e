// Overlap of two convex polygons.
//
// 1. What the pair remembers is tried first: the edge that separated it, or the four edges that
//    crossed.
// 2. Two crossings (nearly every contact). A's outline enters B at p1 and leaves it at p2; when
//    both are proper crossings of edges, A's corners from p1 to p2 lie inside B and B's from p2 to
//    p1 inside A, these bound the region: by convexity the rest of either outline is outside.
// 3. Otherwise, slab: along the line of centroids, only A's corners beyond B's nearest corner and
// B's edges
//    before A's farthest corner can bound the region: a few of each for a light contact.
// 4. Those corners of A, closed to a polygon, are clipped by the lines of those edges of B, one
//    after the other (Sutherland and Hodgman 1974). The loop is closed after every cut, whatever
//    round-off does, so that its area is accurate for parallel and coincident sides too.
// 5. Sums over the loop: overlap_region.h.
//
// The memory decides nothing that the rest would not: remembered edges must pass the test that
// finds them, and a region so small that round-off could have made it is checked against the test
// of every edge.
#include <algorithm>
#include <stdexcept>

#include "dem/shapes/overlap_region.h"

namespace grainfield::dem {

namespace {

using region::Loop;

// What the slab is widened by, over r_i + r_j: far above round-off, far below anything that costs.
constexpr double kSlabMargin = 1e-9;

// True when edge k of `shape` has no corner of `other` on its inner side. `gap`: the least distance
// times the length of the edge.
inline bool separates(const PlacedShape& shape, int k, const PlacedShape& other, double& gap) {
  const double px = shape.x[k], py = shape.y[k];
  const double ex = shape.x[k + 1] - px, ey = shape.y[k + 1] - py;
  double least = ey * (other.x[0] - px) - ex * (other.y[0] - py);
  for (int m = 1; m < other.n; ++m) {
    const double outside = ey * (other.x[m] - px) - ex * (other.y[m] - py);
    least = outside < least ? outside : least;
  }
  gap = least;
  return least >= 0;
}

inline bool separated_as_before(const PlacedShape& a, const PlacedShape& b, PairFeature feature) {
  const auto hint = static_cast<std::uint32_t>(feature.hint);
  if (hint == 0 || hint > kMostHint) return false;
  const std::uint32_t edge = (hint - 1) / 2;
  const bool of_b = ((hint - 1) & 1u) != 0;
  const PlacedShape& shape = of_b ? b : a;
  if (edge >= static_cast<std::uint32_t>(shape.n)) return false;
  double gap = 0;
  return separates(shape, static_cast<int>(edge), of_b ? a : b, gap);
}

// Looks for the edge that separates the two by the widest gap and remembers it.
bool find_separating_edge(const PlacedShape& a, const PlacedShape& b, PairFeature& feature) {
  double widest = -1;
  for (int side = 0; side < 2; ++side) {
    const PlacedShape &shape = side == 0 ? a : b, &other = side == 0 ? b : a;
    for (int k = 0; k < shape.n; ++k) {
      double gap = 0;
      if (!separates(shape, k, other, gap)) continue;
      const double ex = shape.x[k + 1] - shape.x[k], ey = shape.y[k + 1] - shape.y[k];
      const double distance = gap / std::sqrt(ex * ex + ey * ey);
      if (distance > widest) {
        widest = distance;
        feature.hint = 1 + 2 * k + side;
      }
    }
  }
  return widest >= 0;
}

// A's edges on which its outline enters and leaves B, and B's on which it enters and leaves A.
// Corners of A from enter_a + 1 to leave_a are inside B, of B from enter_b + 1 to leave_b inside A.
struct Crossings {
  int enter_a = -1, leave_a = -1, enter_b = -1, leave_b = -1;

  std::int32_t packed() const {
    return static_cast<std::int32_t>(
        kCrossed | static_cast<std::uint32_t>(enter_a) | static_cast<std::uint32_t>(leave_a) << 6 |
        static_cast<std::uint32_t>(enter_b) << 12 | static_cast<std::uint32_t>(leave_b) << 18);
  }
};

// False when the memory holds none, or none that these shapes could have.
inline bool unpack(PairFeature feature, const PlacedShape& a, const PlacedShape& b, Crossings& c) {
  const auto hint = static_cast<std::uint32_t>(feature.hint);
  if ((hint >> 24) != (kCrossed >> 24)) return false;
  c.enter_a = static_cast<int>(hint & 63u);
  c.leave_a = static_cast<int>(hint >> 6 & 63u);
  c.enter_b = static_cast<int>(hint >> 12 & 63u);
  c.leave_b = static_cast<int>(hint >> 18 & 63u);
  return c.enter_a < a.n && c.leave_a < a.n && c.enter_b < b.n && c.leave_b < b.n;
}

// Twice the area between edge k and (x, y): positive inside.
inline double inside_of(const PlacedShape& shape, int k, double x, double y) {
  const double px = shape.x[k], py = shape.y[k];
  return (shape.x[k + 1] - px) * (y - py) - (shape.y[k + 1] - py) * (x - px);
}

inline bool inside_of_all(const PlacedShape& shape, double x, double y) {
  double least = inside_of(shape, 0, x, y);
  for (int k = 1; k < shape.n; ++k) {
    const double d = inside_of(shape, k, x, y);
    least = d < least ? d : least;
  }
  return least > 0;
}

// The corners first + 1 ... last of `shape`.
template <class Visit>
inline bool all_corners(const PlacedShape& shape, int first, int last, Visit visit) {
  for (int k = first; k != last;) {
    k = k + 1 < shape.n ? k + 1 : 0;
    if (!visit(shape.x[k], shape.y[k])) return false;
  }
  return true;
}

// Contact of two outlines that cross at these edges. False when they do not (touching is not
// crossing: then there may be two ways to name one point), when they may cross elsewhere too,
// when the region or its chord is too small to be sure of, or when one outline is all but inside
// the other.
inline bool contact_of_crossings(const PlacedShape& a, const PlacedShape& b, const Crossings& c,
                                 Measures measures, Overlap& o) {
  const int ea = c.enter_a, la = c.leave_a, eb = c.enter_b, lb = c.leave_b;
  // p1: A's edge ea comes in through B's edge lb; p2: A's edge la goes out through B's edge eb.
  const double out1 = inside_of(b, lb, a.x[ea], a.y[ea]);
  const double in1 = inside_of(b, lb, a.x[ea + 1], a.y[ea + 1]);
  const double in2 = inside_of(b, eb, a.x[la], a.y[la]);
  const double out2 = inside_of(b, eb, a.x[la + 1], a.y[la + 1]);
  if (!((out1 < 0) & (in1 > 0) & (in2 > 0) & (out2 < 0))) return false;
  if (!((inside_of(a, ea, b.x[lb], b.y[lb]) > 0) &
        (inside_of(a, ea, b.x[lb + 1], b.y[lb + 1]) < 0) &
        (inside_of(a, la, b.x[eb], b.y[eb]) < 0) &
        (inside_of(a, la, b.x[eb + 1], b.y[eb + 1]) > 0))) {
    return false;
  }
  if (!all_corners(a, ea, la, [&](double x, double y) { return inside_of_all(b, x, y); }))
    return false;
  if (!all_corners(b, eb, lb, [&](double x, double y) { return inside_of_all(a, x, y); }))
    return false;

  // From the inner end of A's edges, relative to A's centroid.
  const double t1 = in1 / (in1 - out1), t2 = in2 / (in2 - out2);
  const double ix = a.x[ea + 1], iy = a.y[ea + 1], jx = a.x[la], jy = a.y[la];
  const double x1 = (ix - a.cx) + t1 * (a.x[ea] - ix), y1 = (iy - a.cy) + t1 * (a.y[ea] - iy);
  const double x2 = (jx - a.cx) + t2 * (a.x[la + 1] - jx),
               y2 = (jy - a.cy) + t2 * (a.y[la + 1] - jy);
  const double bx = x2 - x1, by = y2 - y1;
  // Area and extent along the chord's normal, of corners relative to p1.
  double twice = 0, px = 0, py = 0, high = 0, low = 0;
  const auto add = [&](double x, double y) {
    const double qx = (x - a.cx) - x1, qy = (y - a.cy) - y1;
    twice += px * qy - qx * py;
    const double n = qx * by - qy * bx;
    high = n > high ? n : high;
    low = n < low ? n : low;
    px = qx;
    py = qy;
    return true;
  };
  all_corners(a, ea, la, add);
  twice += px * by - bx * py;
  px = bx;
  py = by;
  all_corners(b, eb, lb, add);
  const double squared = bx * bx + by * by, reach = a.radius + b.radius;
  o.area = 0.5 * twice;
  if (!(o.area > kSureArea * reach * reach) || !(squared > kSureArea * reach * reach)) return false;
  if (measures != Measures::gradient && region::weight_of_chord(a, b, o.area, squared) < 1) {
    return false;
  }
  o.chord = std::sqrt(squared);
  const double inverse = 1 / o.chord;
  o.nx = by * inverse;
  o.ny = -bx * inverse;
  o.depth = (high - low) * inverse;
  region::set_contact_point(a, b, x1 + 0.5 * bx, y1 + 0.5 * by, o);
  return true;
}

// The crossings when there are just two. False when there are none or more.
bool find_crossings(const PlacedShape& a, const PlacedShape& b, Crossings& c) {
  unsigned long long b_of_a[kMostCorners];  // bit k: B's corner k is inside A's edge m
  for (int m = 0; m < a.n; ++m) {
    unsigned long long bits = 0;
    for (int k = 0; k < b.n; ++k) {
      bits |= static_cast<unsigned long long>(inside_of(a, m, b.x[k], b.y[k]) > 0) << k;
    }
    b_of_a[m] = bits;
  }
  for (int k = 0; k < b.n; ++k) {
    unsigned long long bits = 0;  // bit m: A's corner m is inside B's edge k
    for (int m = 0; m < a.n; ++m) {
      bits |= static_cast<unsigned long long>(inside_of(b, k, a.x[m], a.y[m]) > 0) << m;
    }
    const unsigned long long next = bits >> 1 | (bits & 1u) << (a.n - 1);
    const int k1 = k + 1 < b.n ? k + 1 : 0;
    for (unsigned long long entering = ~bits & next; entering != 0; entering &= entering - 1) {
      const int m = __builtin_ctzll(entering);
      if ((b_of_a[m] >> k & 1u) == 0 || (b_of_a[m] >> k1 & 1u) != 0) continue;
      if (c.enter_a >= 0) return false;
      c.enter_a = m;
      c.leave_b = k;
    }
    for (unsigned long long leaving = bits & ~next; leaving != 0; leaving &= leaving - 1) {
      const int m = __builtin_ctzll(leaving);
      if ((b_of_a[m] >> k & 1u) != 0 || (b_of_a[m] >> k1 & 1u) == 0) continue;
      if (c.leave_a >= 0) return false;
      c.leave_a = m;
      c.enter_b = k;
    }
  }
  return c.enter_a >= 0 && c.leave_a >= 0;
}

// Keeps what is to the left of the line through (qx, qy) along (ex, ey). Returns the loop that
// holds the result: `from` when nothing was cut off, otherwise `to`.
inline Loop* clip(Loop* from, Loop* to, double qx, double qy, double ex, double ey) {
  double inside[region::kMostPoints];
  double least = 1, most = 0;
  const int n = from->n;
  for (int i = 0; i < n; ++i) {
    const double d = ex * (from->y[i] - qy) - ey * (from->x[i] - qx);
    inside[i] = d;
    least = d < least ? d : least;
    most = d > most ? d : most;
  }
  if (least > 0) return from;
  to->n = 0;
  if (!(most > 0)) return to;
  int before = n - 1;
  for (int i = 0; i < n; before = i++) {
    if ((inside[i] > 0) != (inside[before] > 0)) {
      // From the inner end, so that a side cut twice gives the same bits from both its owners.
      const int in = inside[i] > 0 ? i : before, out = inside[i] > 0 ? before : i;
      const double t = inside[in] / (inside[in] - inside[out]);
      // Entering: the side goes on as its owner's; leaving: B's edge begins.
      to->add(from->x[in] + t * (from->x[out] - from->x[in]),
              from->y[in] + t * (from->y[out] - from->y[in]),
              inside[i] > 0 ? from->of_b[before] : 1.0);
    }
    if (inside[i] > 0) to->add(from->x[i], from->y[i], from->of_b[i]);
    if (to->n > region::kMostPoints - 2) break;  // only if round-off made a saw of it
  }
  return to;
}

// The corners of A beyond the slab's lower side, with one more at either end, relative to (ox, oy).
void start_loop(const PlacedShape& a, int first, double dx, double dy, double low, double ox,
                double oy, Loop& loop) {
  const auto along = [&](int k) { return dx * (a.x[k] - a.cx) + dy * (a.y[k] - a.cy); };
  int begin = first, end = first;  // the corners begin ... end, counter-clockwise
  int count = 1;
  while (count < a.n) {
    end = end + 1 < a.n ? end + 1 : 0;
    ++count;
    if (!(along(end) > low)) break;
  }
  while (count < a.n) {
    begin = begin > 0 ? begin - 1 : a.n - 1;
    ++count;
    if (!(along(begin) > low)) break;
  }
  for (int k = begin, m = 0; m < count; ++m, k = k + 1 < a.n ? k + 1 : 0) {
    loop.add(a.x[k] - ox, a.y[k] - oy, 0.0);
  }
}

// Steps 2 to 5. Returns false when the region is empty.
bool overlap_of_polygons(const PlacedShape& a, const PlacedShape& b, PairFeature& feature,
                         Measures measures, Overlap& o, bool& in_doubt) {
  const double reach = a.radius + b.radius;
  double dx = b.cx - a.cx, dy = b.cy - a.cy;
  const double squared = dx * dx + dy * dy;
  in_doubt = false;
  if (squared > reach * reach) return false;
  in_doubt = true;
  if (squared < 1e-16 * reach * reach) {  // any axis will do
    dx = reach;
    dy = 0;
  }
  // The slab, along (dx, dy) from A's centroid.
  int far = 0, near = 0;
  double high = dx * (a.x[0] - a.cx) + dy * (a.y[0] - a.cy);
  for (int k = 1; k < a.n; ++k) {
    const double p = dx * (a.x[k] - a.cx) + dy * (a.y[k] - a.cy);
    if (p > high) high = p, far = k;
  }
  double low = dx * (b.x[0] - a.cx) + dy * (b.y[0] - a.cy);
  for (int k = 1; k < b.n; ++k) {
    const double p = dx * (b.x[k] - a.cx) + dy * (b.y[k] - a.cy);
    if (p < low) low = p, near = k;
  }
  if (low >= high) return false;
  Crossings crossings;
  if (find_crossings(a, b, crossings) && contact_of_crossings(a, b, crossings, measures, o)) {
    feature.hint = crossings.packed();
    return true;
  }
  const double margin = kSlabMargin * reach * std::sqrt(dx * dx + dy * dy);
  low -= margin;
  high += margin;

  Loop one, other;
  Loop *loop = &one, *spare = &other;
  const double ox = a.x[far], oy = a.y[far];
  start_loop(a, far, dx, dy, low, ox, oy, *loop);
  const auto cut = [&](int k) {
    // From the same differences as the loop's corners: coincident corners are exactly on the line.
    const double qx = b.x[k] - ox, qy = b.y[k] - oy;
    Loop* result = clip(loop, spare, qx, qy, (b.x[k + 1] - ox) - qx, (b.y[k + 1] - oy) - qy);
    if (result != loop) std::swap(loop, spare);
    return loop->n > 2;
  };
  const auto inside_slab = [&](int k) {
    return dx * (b.x[k] - a.cx) + dy * (b.y[k] - a.cy) < high;
  };
  // B's edges upwards from its nearest corner while they begin in the slab, then downwards.
  int edges = 0, k = near;
  do {
    if (!cut(k)) return false;
    ++edges;
    k = k + 1 < b.n ? k + 1 : 0;
  } while (edges < b.n && inside_slab(k));
  k = near;
  while (edges < b.n) {
    const int previous = k > 0 ? k - 1 : b.n - 1;
    if (!cut(previous)) return false;
    ++edges;
    k = previous;
    if (!inside_slab(k)) break;
  }
  return region::contact_of_loop(
      a, b, *loop, ox - a.cx, oy - a.cy, region::Arcs{},
      [](region::Extents&, double, double, double, double) {}, measures, o);
}

}  // namespace

bool overlap_of_shapes(const PlacedShape& a, const PlacedShape& b, PairFeature& feature,
                       Overlap& overlap, Measures measures) {
  if (a.n == 0 || b.n == 0) {
    if (a.n != b.n) return region::overlap_of_disk_and_polygon(a, b, feature, measures, overlap);
    return region::overlap_of_two_disks(a, b, measures, overlap);
  }
  if (a.n > kMostCorners || b.n > kMostCorners) {
    throw std::invalid_argument("a polygon with more than 64 corners");
  }
  if (separated_as_before(a, b, feature)) return false;
  Crossings crossings;
  if (unpack(feature, a, b, crossings) &&
      contact_of_crossings(a, b, crossings, measures, overlap)) {
    return true;
  }
  feature.hint = 0;
  bool in_doubt = false;
  const bool found = overlap_of_polygons(a, b, feature, measures, overlap, in_doubt);
  const double reach = a.radius + b.radius;
  if (found && overlap.area > kSureArea * reach * reach) return true;
  if (in_doubt && find_separating_edge(a, b, feature)) return false;
  return found;
}

}  // namespace grainfield::dem
