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
  return static_cast<int>(std::clamp((x - x0_) / level.cell, 0.0, level.nx - 1.0));
}
int HierarchicalGrid::row(const Level& level, double y) const {
  return static_cast<int>(std::clamp((y - y0_) / level.cell, 0.0, level.ny - 1.0));
}

void HierarchicalGrid::build(std::span<const Reach> grains) {
  grains_.assign(grains.begin(), grains.end());
  level_of_.assign(grains.size(), 0);
  if (grains.empty()) {
    levels_.clear();
    return;
  }
  constexpr double inf = std::numeric_limits<double>::infinity();
  double x1 = -inf, y1 = -inf, least = inf, most = 0;
  x0_ = y0_ = inf;
  for (const Reach& g : grains) {
    x0_ = std::min(x0_, g.x);
    y0_ = std::min(y0_, g.y);
    x1 = std::max(x1, g.x);
    y1 = std::max(y1, g.y);
    least = std::min(least, g.reach);
    most = std::max(most, g.reach);
  }
  finest_ = 2 * least;
  const double limit = kMaxCellsPerGrain * static_cast<double>(grains.size()) + 64;
  while (((x1 - x0_) / finest_ + 1) * ((y1 - y0_) / finest_ + 1) > limit) finest_ *= 1.5;
  int count = 1;
  while (count < kMaxLevels && finest_ * std::ldexp(1.0, count - 1) < 2 * most) ++count;
  levels_.resize(count);
  for (int l = 0; l < count; ++l) {
    Level& level = levels_[l];
    level.cell = std::ldexp(finest_, l);
    level.nx = static_cast<int>((x1 - x0_) / level.cell) + 1;
    level.ny = static_cast<int>((y1 - y0_) / level.cell) + 1;
    level.start.assign(static_cast<std::size_t>(level.nx) * level.ny + 1, 0);
  }
  const int n = static_cast<int>(grains.size());
  cell_of_.resize(n);
  for (int i = 0; i < n; ++i) {
    int l = 0;
    while (l + 1 < count && levels_[l].cell < 2 * grains[i].reach) ++l;
    level_of_[i] = static_cast<unsigned char>(l);
    Level& level = levels_[l];
    cell_of_[i] = column(level, grains[i].x) + level.nx * row(level, grains[i].y);
    ++level.start[cell_of_[i] + 1];
  }
  for (int l = 0; l < count; ++l) {
    Level& level = levels_[l];
    std::partial_sum(level.start.begin(), level.start.end(), level.start.begin());
    level.members.resize(level.start.back());
    cursor_.assign(level.start.begin(), level.start.end());
    for (int i = 0; i < n; ++i) {
      if (level_of_[i] == l) level.members[cursor_[cell_of_[i]]++] = i;
    }
  }
}

template <class Visit>
void HierarchicalGrid::visit_cells(const Level& level, const Reach& grain, Visit visit) const {
  // A partner on this level reaches at most half a cell.
  const double reach = grain.reach + 0.5 * level.cell;
  const int c0 = column(level, grain.x - reach), c1 = column(level, grain.x + reach);
  const int r0 = row(level, grain.y - reach), r1 = row(level, grain.y + reach);
  for (int r = r0; r <= r1; ++r) {
    for (int k = level.start[c0 + level.nx * r]; k < level.start[c1 + level.nx * r + 1]; ++k) {
      const int j = level.members[k];
      const Reach& b = grains_[j];
      const double dx = b.x - grain.x, dy = b.y - grain.y, sum = grain.reach + b.reach;
      if (dx * dx + dy * dy < sum * sum) visit(j);
    }
  }
}

void HierarchicalGrid::near(const Reach& grain, std::vector<int>& found) const {
  const auto first = static_cast<std::ptrdiff_t>(found.size());
  for (const Level& level : levels_) {
    if (!level.members.empty()) {
      visit_cells(level, grain, [&](int j) {
        if (!(grain.fixed && grains_[j].fixed)) found.push_back(j);
      });
    }
  }
  std::sort(found.begin() + first, found.end());
}

void HierarchicalGrid::pairs(std::vector<std::pair<int, int>>& pairs) const {
  pairs.clear();
  const int n = static_cast<int>(grains_.size());
  for (int i = 0; i < n; ++i) {
    const Reach& a = grains_[i];
    for (int l = level_of_[i]; l < static_cast<int>(levels_.size()); ++l) {
      const Level& level = levels_[l];
      if (level.members.empty()) continue;
      visit_cells(level, a, [&](int j) {
        if (l == level_of_[i] && j <= i) return;
        if (a.fixed && grains_[j].fixed) return;
        pairs.emplace_back(std::min(i, j), std::max(i, j));
      });
    }
  }
  // Counting sort by the first, then each short row by the second.
  std::vector<int> start(n + 1, 0);
  for (const auto& p : pairs) ++start[p.first + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::pair<int, int>> sorted(pairs.size());
  std::vector<int> cursor(start);
  for (const auto& p : pairs) sorted[cursor[p.first]++] = p;
  for (int i = 0; i < n; ++i) std::sort(sorted.begin() + start[i], sorted.begin() + start[i + 1]);
  pairs.swap(sorted);
}

std::vector<int> HierarchicalGrid::order() const {
  std::vector<std::pair<std::int64_t, int>> keyed(grains_.size());
  for (std::size_t i = 0; i < grains_.size(); ++i) {
    const Level& level = levels_.front();
    const std::int64_t c = column(level, grains_[i].x), r = row(level, grains_[i].y);
    keyed[i] = {level.nx < level.ny ? c + r * level.nx : r + c * level.ny, static_cast<int>(i)};
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<int> order(grains_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].second;
  return order;
}

}  // namespace grainfield::dem
