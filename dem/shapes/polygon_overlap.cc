// Overlap of two convex polygons.
//
// 1. The edge that separated the pair last step is tried first.
// 2. Slab: along the line of centroids, only A's corners beyond B's nearest corner and B's edges
//    before A's farthest corner can bound the region: a few of each for a light contact.
// 3. Those corners of A, closed to a polygon, are clipped by the lines of those edges of B, one
//    after the other (Sutherland and Hodgman 1974). The loop is closed after every cut, whatever
//    round-off does, so that its area is accurate for parallel and coincident sides too.
// 4. Sums over the loop: overlap_region.h.
//
// Only step 1 looks at the memory, and it decides nothing that the rest would not: a region so
// small that round-off could have made it is checked against the same test of every edge.
#include <algorithm>
#include <stdexcept>

#include "dem/shapes/overlap_region.h"

namespace grainfield::dem {

namespace {

using region::Loop;

// Of (r_i + r_j)^2: a larger region is more than round-off (some 100 times its bound).
constexpr double kSureArea = 1e-13;
// Of r_i + r_j: what the slab is widened by, far above round-off, far below anything that costs.
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

// The memory: 0 nothing, otherwise 1 + 2 edge + (0: A's, 1: B's).
inline bool separated_as_before(const PlacedShape& a, const PlacedShape& b, PairFeature feature) {
  const auto hint = static_cast<std::uint32_t>(feature.hint);
  if (hint == 0) return false;
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

// Everything but the hint. Returns false when the region is empty.
bool overlap_of_polygons(const PlacedShape& a, const PlacedShape& b, Overlap& o, bool& in_doubt) {
  const double reach = a.radius + b.radius;
  double dx = b.cx - a.cx, dy = b.cy - a.cy;
  const double squared = dx * dx + dy * dy;
  in_doubt = false;
  if (squared > reach * reach) return false;
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
  in_doubt = true;
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
      a, b, *loop, ox - a.cx, oy - a.cy, 0.0,
      [](region::Extents&, double, double, double, double) {}, o);
}

}  // namespace

bool overlap_of_shapes(const PlacedShape& a, const PlacedShape& b, PairFeature& feature,
                       Overlap& overlap) {
  if (a.n == 0 || b.n == 0) {
    if (a.n != b.n) return region::overlap_of_disk_and_polygon(a, b, feature, overlap);
    return region::overlap_of_two_disks(a, b, overlap);
  }
  if (a.n > kMostCorners || b.n > kMostCorners) {
    throw std::invalid_argument("a polygon with more than 64 corners");
  }
  if (separated_as_before(a, b, feature)) return false;
  bool in_doubt = false;
  const bool found = overlap_of_polygons(a, b, overlap, in_doubt);
  const double reach = a.radius + b.radius;
  if (found && overlap.area > kSureArea * reach * reach) {
    feature.hint = 0;
    return true;
  }
  if (in_doubt && find_separating_edge(a, b, feature)) return false;
  return found;
}

}  // namespace grainfield::dem
