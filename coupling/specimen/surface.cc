#include "coupling/specimen/surface.h"

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "coupling/averaging/columns.h"
#include "dem/grains/placed.h"

namespace grainfield::coupling {
namespace {

using dem::Grain;
using dem::Outline;
using dem::Snapshot;

using boost::math::statistics::median;  // reorders what it is given

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFlankLow = 0.15, kFlankHigh = 0.85;
// Fewer columns on a flank than this give no line.
constexpr std::size_t kLeastColumns = 5;
// The columns that the line picks settle after two or three rounds.
constexpr int kRounds = 10;
// Standard deviation of a normal distribution over its median absolute deviation.
constexpr double kNormalMad = 1.4826;
constexpr double kDegrees = 180 / std::numbers::pi;

// Highest point of a convex polygon between x = left and x = right; -infinity if it has none there.
double top_between(const Outline& corners, double left, double right) {
  double top = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto& p = corners[k];
    const auto& q = corners[(k + 1) % corners.size()];
    if (p[0] >= left && p[0] <= right) top = std::max(top, p[1]);
    for (const double x : {left, right}) {
      if ((p[0] < x && q[0] > x) || (p[0] > x && q[0] < x)) {
        top = std::max(top, p[1] + (q[1] - p[1]) * (x - p[0]) / (q[0] - p[0]));
      }
    }
  }
  return top;
}

double disk_top_between(const Grain& g, double left, double right) {
  const double away = g.position.x() - std::clamp(g.position.x(), left, right);
  const double square = g.radius * g.radius - away * away;
  return square < 0 ? -std::numeric_limits<double>::infinity() : g.position.y() + std::sqrt(square);
}

struct Point {
  double x, y;
};

FlankLine theil_sen(const std::vector<Point>& points) {
  FlankLine line;
  line.columns = static_cast<int>(points.size());
  if (points.size() < kLeastColumns) {
    line.slope = line.at_zero = line.slope_error = kNan;
    return line;
  }
  std::vector<double> slopes, offsets, residuals;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      slopes.push_back((points[j].y - points[i].y) / (points[j].x - points[i].x));
    }
  }
  line.slope = median(slopes);
  double mean = 0, square = 0;
  for (const Point& p : points) {
    offsets.push_back(p.y - line.slope * p.x);
    mean += p.x / static_cast<double>(points.size());
  }
  line.at_zero = median(offsets);
  for (const Point& p : points) {
    residuals.push_back(std::fabs(p.y - line.at_zero - line.slope * p.x));
    square += (p.x - mean) * (p.x - mean);
  }
  line.slope_error = kNormalMad * median(residuals) / std::sqrt(square);
  return line;
}

// Columns on one side of the highest one, from the top outwards.
FlankLine fit_flank(const std::vector<Point>& side, double height) {
  const double low = kFlankLow * height, high = kFlankHigh * height;
  // To begin with: from the last column above `high` to the last one in a row above `low`.
  std::vector<Point> chosen;
  for (const Point& p : side) {
    if (p.y < low) break;
    if (p.y > high) {
      chosen.clear();
    } else {
      chosen.push_back(p);
    }
  }
  FlankLine line = theil_sen(chosen);
  for (int round = 0; round < kRounds && line.columns >= static_cast<int>(kLeastColumns); ++round) {
    std::vector<Point> next;
    for (const Point& p : side) {
      const double y = line.at_zero + line.slope * p.x;
      if (y >= low && y <= high) next.push_back(p);
    }
    if (next.size() == chosen.size() &&
        std::equal(next.begin(), next.end(), chosen.begin(),
                   [](const Point& a, const Point& b) { return a.x == b.x; })) {
      break;
    }
    chosen = std::move(next);
    line = theil_sen(chosen);
  }
  return line;
}

}  // namespace

Surface free_surface(const Snapshot& snapshot, double column) {
  if (!(column > 0)) throw std::invalid_argument("free_surface: columns need a width above 0");
  Surface s;
  s.column = column;
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (const Grain& g : snapshot.grains) {
    if (g.fixed) continue;
    left = std::min(left, g.position.x() - g.radius);
    right = std::max(right, g.position.x() + g.radius);
  }
  if (!(right > left)) return s;
  // Columns at whole multiples of their width, so that snapshots share them.
  const double first = std::floor(left / column), last = std::ceil(right / column);
  s.left = first * column;
  s.top.assign(count_columns(snapshot, 0, s.left, (last + 0.5) * column, column), 0.0);
  for (const Grain& g : snapshot.grains) {
    if (g.fixed) continue;
    const Outline corners = dem::placed_outline(g);
    const auto from = static_cast<std::size_t>((g.position.x() - g.radius - s.left) / column);
    const auto to = static_cast<std::size_t>((g.position.x() + g.radius - s.left) / column);
    for (std::size_t k = from; k <= to && k < s.top.size(); ++k) {
      const double x = s.left + static_cast<double>(k) * column;
      s.top[k] = std::max(s.top[k], corners.empty() ? disk_top_between(g, x, x + column)
                                                    : top_between(corners, x, x + column));
    }
  }
  return s;
}

HeapShape measure_heap(const Surface& surface) {
  HeapShape heap;
  if (surface.top.empty()) {
    heap.height = heap.apex_x = heap.foot_left = heap.foot_right = kNan;
    heap.repose_left_deg = heap.repose_right_deg = kNan;
    heap.repose_left_error_deg = heap.repose_right_error_deg = kNan;
    heap.left = heap.right = theil_sen({});
    return heap;
  }
  const auto highest = std::max_element(surface.top.begin(), surface.top.end());
  const auto apex = static_cast<std::size_t>(highest - surface.top.begin());
  heap.height = *highest;
  std::vector<Point> left, right;
  for (std::size_t k = apex; k-- > 0;) left.push_back({surface.middle(k), surface.top[k]});
  for (std::size_t k = apex + 1; k < surface.top.size(); ++k) {
    right.push_back({surface.middle(k), surface.top[k]});
  }
  heap.left = fit_flank(left, heap.height);
  heap.right = fit_flank(right, heap.height);
  const auto degrees = [](double slope) { return std::atan(slope) * kDegrees; };
  const auto error = [](const FlankLine& l) {
    return l.slope_error / (1 + l.slope * l.slope) * kDegrees;
  };
  heap.repose_left_deg = degrees(heap.left.slope);
  heap.repose_right_deg = degrees(-heap.right.slope);
  heap.repose_left_error_deg = error(heap.left);
  heap.repose_right_error_deg = error(heap.right);
  heap.foot_left = -heap.left.at_zero / heap.left.slope;
  heap.foot_right = -heap.right.at_zero / heap.right.slope;
  heap.apex_x = (heap.left.at_zero - heap.right.at_zero) / (heap.right.slope - heap.left.slope);
  if (!(heap.apex_x > heap.foot_left && heap.apex_x < heap.foot_right)) heap.apex_x = kNan;
  return heap;
}

Stretch plateau_of(const Surface& surface, const Stretch& last, double drop) {
  std::vector<double> tops;
  std::size_t first = surface.top.size(), end = 0;
  for (std::size_t k = 0; k < surface.top.size(); ++k) {
    if (surface.middle(k) < last.left || surface.middle(k) > last.right) continue;
    first = std::min(first, k);
    end = k + 1;
    tops.push_back(surface.top[k]);
  }
  const double middle = 0.5 * (last.left + last.right);
  if (tops.empty()) return {middle, middle};
  std::nth_element(tops.begin(), tops.begin() + tops.size() / 2, tops.end());
  const double least = tops[tops.size() / 2] - drop;
  while (surface.top[first] < least) ++first;
  while (surface.top[end - 1] < least) --end;
  // A column whose middle is in the stretch may reach beyond it.
  return {std::max(last.left, surface.left + static_cast<double>(first) * surface.column),
          std::min(last.right, surface.left + static_cast<double>(end) * surface.column)};
}

}  // namespace grainfield::coupling
