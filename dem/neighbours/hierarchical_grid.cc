#include "dem/neighbours/hierarchical_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace grainfield::dem {
namespace {

// More cells than this per grain would cost more than they save; then cells grow instead.
constexpr double kMaxCellsPerGrain = 16;
constexpr int kMaxLevels = 24;

}  // namespace

int HierarchicalGrid::column(const Level& level, double x) const {
  return std::clamp(static_cast<int>((x - x0_) / level.cell), 0, level.nx - 1);
}
int HierarchicalGrid::row(const Level& level, double y) const {
  return std::clamp(static_cast<int>((y - y0_) / level.cell), 0, level.ny - 1);
}

void HierarchicalGrid::build(std::span<const Body> bodies, double skin) {
  skin_ = skin;
  levels_.clear();
  level_of_.assign(bodies.size(), 0);
  if (bodies.empty()) return;
  constexpr double inf = std::numeric_limits<double>::infinity();
  double x1 = -inf, y1 = -inf, least = inf, most = 0;
  x0_ = y0_ = inf;
  for (const Body& b : bodies) {
    x0_ = std::min(x0_, b.x);
    y0_ = std::min(y0_, b.y);
    x1 = std::max(x1, b.x);
    y1 = std::max(y1, b.y);
    least = std::min(least, b.radius);
    most = std::max(most, b.radius);
  }
  finest_ = 2 * least + skin;
  const double limit = kMaxCellsPerGrain * static_cast<double>(bodies.size()) + 64;
  while (((x1 - x0_) / finest_ + 1) * ((y1 - y0_) / finest_ + 1) > limit) finest_ *= 1.5;
  int count = 1;
  while (count < kMaxLevels && finest_ * std::ldexp(1.0, count - 1) < 2 * most + skin) ++count;
  levels_.resize(count);
  for (int l = 0; l < count; ++l) {
    Level& level = levels_[l];
    level.cell = std::ldexp(finest_, l);
    level.nx = static_cast<int>((x1 - x0_) / level.cell) + 1;
    level.ny = static_cast<int>((y1 - y0_) / level.cell) + 1;
    level.start.assign(static_cast<std::size_t>(level.nx) * level.ny + 1, 0);
  }
  const int n = static_cast<int>(bodies.size());
  std::vector<int> cell_of(n);
  for (int i = 0; i < n; ++i) {
    int l = 0;
    while (l + 1 < count && levels_[l].cell < 2 * bodies[i].radius + skin) ++l;
    level_of_[i] = static_cast<unsigned char>(l);
    Level& level = levels_[l];
    cell_of[i] = column(level, bodies[i].x) + level.nx * row(level, bodies[i].y);
    ++level.start[cell_of[i] + 1];
  }
  for (Level& level : levels_) {
    std::partial_sum(level.start.begin(), level.start.end(), level.start.begin());
    level.members.resize(level.start.back());
  }
  std::vector<std::vector<int>> cursor(count);
  for (int l = 0; l < count; ++l) cursor[l] = levels_[l].start;
  for (int i = 0; i < n; ++i) {
    const int l = level_of_[i];
    levels_[l].members[cursor[l][cell_of[i]]++] = i;
  }
}

void HierarchicalGrid::pairs(std::span<const Body> bodies,
                             std::vector<std::pair<int, int>>& pairs) const {
  pairs.clear();
  const int n = static_cast<int>(bodies.size());
  for (int i = 0; i < n; ++i) {
    const Body& a = bodies[i];
    for (int l = level_of_[i]; l < static_cast<int>(levels_.size()); ++l) {
      const Level& level = levels_[l];
      if (level.members.empty()) continue;
      // A partner on this level has a diameter of at most cell - skin.
      const double reach = a.radius + 0.5 * (level.cell - skin_) + skin_;
      const int c0 = column(level, a.x - reach), c1 = column(level, a.x + reach);
      const int r0 = row(level, a.y - reach), r1 = row(level, a.y + reach);
      for (int r = r0; r <= r1; ++r) {
        for (int k = level.start[c0 + level.nx * r]; k < level.start[c1 + level.nx * r + 1]; ++k) {
          const int j = level.members[k];
          if (l == level_of_[i] && j <= i) continue;
          const Body& b = bodies[j];
          if (a.inverse_mass == 0 && b.inverse_mass == 0) continue;
          const double dx = b.x - a.x, dy = b.y - a.y, sum = a.radius + b.radius + skin_;
          if (dx * dx + dy * dy < sum * sum) pairs.emplace_back(std::min(i, j), std::max(i, j));
        }
      }
    }
  }
  // Counting sort by the first, then each short row by the second.
  std::vector<int> start(n + 1, 0);
  for (const auto& p : pairs) ++start[p.first + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::pair<int, int>> sorted(pairs.size());
  std::vector<int> cursor(start.begin(), start.end() - (n >= 0 ? 1 : 0));
  for (const auto& p : pairs) sorted[cursor[p.first]++] = p;
  for (int i = 0; i < n; ++i) std::sort(sorted.begin() + start[i], sorted.begin() + start[i + 1]);
  pairs.swap(sorted);
}

std::vector<int> HierarchicalGrid::order(std::span<const Body> bodies) const {
  std::vector<std::pair<std::int64_t, int>> keyed(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Level& level = levels_.front();
    const std::int64_t c = column(level, bodies[i].x), r = row(level, bodies[i].y);
    keyed[i] = {level.nx < level.ny ? c + r * level.nx : r + c * level.ny, static_cast<int>(i)};
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<int> order(bodies.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].second;
  return order;
}

}  // namespace grainfield::dem
