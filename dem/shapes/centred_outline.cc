// Checks of an outline that a user gave, in the order in which the later ones need the earlier.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "dem/shapes/polygon.h"

namespace grainfield::dem {

namespace {

using Point = std::array<double, 2>;

// Corners closer than this part of the outline's extent coincide.
constexpr double kCoincident = 1e-9;
// Sine of the largest turn to the wrong side that still counts as straight (round-off of corners
// that were written with about 9 digits).
constexpr double kStraight = 1e-9;
// Largest longest extent over shortest extent.
constexpr double kSlenderness = 20;

double cross(const Point& o, const Point& a, const Point& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}
double dot(const Point& o, const Point& a, const Point& b) {
  return (a[0] - o[0]) * (b[0] - o[0]) + (a[1] - o[1]) * (b[1] - o[1]);
}
double distance(const Point& a, const Point& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); }

std::string named(const Outline& outline, std::size_t k) {
  return fmt::format("corner {} ({:g}, {:g})", k + 1, outline[k][0], outline[k][1]);
}

void check_count_and_values(const Outline& outline) {
  if (outline.size() < 3) {
    throw std::invalid_argument(fmt::format(
        "an outline needs at least 3 corners (x1, y1, x2, y2, x3, y3), found {}", outline.size()));
  }
  if (outline.size() > static_cast<std::size_t>(kMostCorners)) {
    throw std::invalid_argument(
        fmt::format("an outline has at most {} corners, found {}", kMostCorners, outline.size()));
  }
  for (std::size_t k = 0; k < outline.size(); ++k) {
    if (!std::isfinite(outline[k][0]) || !std::isfinite(outline[k][1])) {
      throw std::invalid_argument(named(outline, k) + " is not a pair of finite numbers");
    }
  }
}

// Largest distance between two corners.
double longest_extent(const Outline& outline) {
  double extent = 0;
  for (const Point& a : outline) {
    for (const Point& b : outline) extent = std::max(extent, distance(a, b));
  }
  return extent;
}

// Smallest width: between an edge's line and the corner farthest from it.
double shortest_extent(const Outline& outline) {
  const std::size_t n = outline.size();
  double extent = INFINITY;
  for (std::size_t k = 0; k < n; ++k) {
    const Point &a = outline[k], &b = outline[(k + 1) % n];
    double width = 0;
    for (const Point& c : outline) {
      width = std::max(width, std::fabs(cross(a, b, c)) / distance(a, b));
    }
    extent = std::min(extent, width);
  }
  return extent;
}

void check_distinct(const Outline& outline, double extent) {
  for (std::size_t k = 0; k < outline.size(); ++k) {
    for (std::size_t m = 0; m < k; ++m) {
      if (distance(outline[k], outline[m]) <= kCoincident * extent) {
        throw std::invalid_argument(fmt::format(
            "{} coincides with corner {}: give each corner once", named(outline, k), m + 1));
      }
    }
  }
}

void check_simple(const Outline& outline) {
  const std::size_t n = outline.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Point &a = outline[k], &b = outline[(k + 1) % n];
    for (std::size_t m = k + 2; m < n && m < k + n - 1; ++m) {
      const Point &c = outline[m], &d = outline[(m + 1) % n];
      if (cross(a, b, c) * cross(a, b, d) < 0 && cross(c, d, a) * cross(c, d, b) < 0) {
        throw std::invalid_argument(fmt::format(
            "the edge from {} crosses the edge from {}: the outline crosses itself; list "
            "the corners in their order round the grain",
            named(outline, k), named(outline, m)));
      }
    }
  }
}

// `sense` +1: counter-clockwise, -1: clockwise.
void check_convex(const Outline& outline, double sense) {
  const std::size_t n = outline.size();
  double turning = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Point &before = outline[(k + n - 1) % n], &here = outline[k],
                &after = outline[(k + 1) % n];
    const Point ahead = {2 * here[0] - before[0], 2 * here[1] - before[1]};
    const double sine = sense * cross(here, ahead, after), cosine = dot(here, ahead, after);
    const double angle = std::atan2(sine, cosine);
    turning += angle;
    if (std::fabs(angle) > 3.14159265) {
      throw std::invalid_argument(named(outline, k) +
                                  " turns straight back: the outline folds; "
                                  "list the corners in their order round the grain");
    }
    if (angle < -kStraight) {
      throw std::invalid_argument(named(outline, k) +
                                  " turns inwards: the outline is not convex; "
                                  "leave that corner out, or give the convex hull");
    }
  }
  if (turning > 7) {  // 2 pi for one way round, 4 pi and more for stars
    throw std::invalid_argument(
        fmt::format("the outline goes {:.0f} times round its inside: it crosses itself; list the "
                    "corners in their order round the grain",
                    turning / 6.283185307179586));
  }
}

}  // namespace

Outline centred_outline(const Outline& corners) {
  check_count_and_values(corners);
  const double longest = longest_extent(corners);
  check_distinct(corners, longest);
  const double shortest = shortest_extent(corners);
  if (!(longest <= kSlenderness * shortest)) {
    throw std::invalid_argument(
        fmt::format("the outline is a sliver: its longest extent {:g} is more than {:g} times its "
                    "shortest one, "
                    "{:g}; give it more width",
                    longest, kSlenderness, shortest));
  }
  check_simple(corners);
  const double area = area_of(corners);
  check_convex(corners, area < 0 ? -1.0 : 1.0);
  const Point centroid = centroid_of(corners);
  Outline outline = corners;
  if (area < 0) std::reverse(outline.begin(), outline.end());
  for (Point& corner : outline) {
    corner[0] -= centroid[0];
    corner[1] -= centroid[1];
  }
  return outline;
}

}  // namespace grainfield::dem
