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

template <int D>
auto HierarchicalGrid<D>::cell_at(const Level& level, const PlainVector<D>& at) const -> Cell {
  Cell cell;
  for (int a = 0; a < D; ++a) {
    cell[a] =
        static_cast<int>(std::clamp((at[a] - low_[a]) / level.cell, 0.0, level.count[a] - 1.0));
  }
  return cell;
}

template <int D>
int HierarchicalGrid<D>::number_of(const Level& level, const Cell& cell) {
  int number = cell[D - 1];
  for (int a = D - 2; a >= 0; --a) number = cell[a] + level.count[a] * number;
  return number;
}

template <int D>
void HierarchicalGrid<D>::build(std::span<const Reach<D>> grains) {
  grains_.assign(grains.begin(), grains.end());
  level_of_.assign(grains.size(), 0);
  if (grains.empty()) {
    levels_.clear();
    return;
  }
  constexpr double inf = std::numeric_limits<double>::infinity();
  double least = inf, most = 0;
  low_.setConstant(inf);
  PlainVector<D> high = PlainVector<D>::Constant(-inf);
  for (const Reach<D>& g : grains) {
    low_ = low_.cwiseMin(g.centre);
    high = high.cwiseMax(g.centre);
    least = std::min(least, g.reach);
    most = std::max(most, g.reach);
  }
  finest_ = 2 * least;
  const double limit = kMaxCellsPerGrain * static_cast<double>(grains.size()) + 64;
  const auto cells = [&] { return ((high - low_).array() / finest_ + 1).prod(); };
  while (cells() > limit) finest_ *= 1.5;
  int count = 1;
  while (count < kMaxLevels && finest_ * std::ldexp(1.0, count - 1) < 2 * most) ++count;
  levels_.resize(count);
  for (int l = 0; l < count; ++l) {
    Level& level = levels_[l];
    level.cell = std::ldexp(finest_, l);
    std::size_t number = 1;
    for (int a = 0; a < D; ++a) {
      level.count[a] = static_cast<int>((high[a] - low_[a]) / level.cell) + 1;
      number *= static_cast<std::size_t>(level.count[a]);
    }
    level.start.assign(number + 1, 0);
  }
  const int n = static_cast<int>(grains.size());
  cell_of_.resize(n);
  for (int i = 0; i < n; ++i) {
    int l = 0;
    while (l + 1 < count && levels_[l].cell < 2 * grains[i].reach) ++l;
    level_of_[i] = static_cast<unsigned char>(l);
    Level& level = levels_[l];
    cell_of_[i] = number_of(level, cell_at(level, grains[i].centre));
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

template <int D>
template <class Visit>
void HierarchicalGrid<D>::visit_cells(const Level& level, const Reach<D>& grain, int least,
                                      Visit visit) const {
  // A partner on this level reaches at most half a cell.
  const PlainVector<D> reach = PlainVector<D>::Constant(grain.reach + 0.5 * level.cell);
  const Cell low = cell_at(level, grain.centre - reach),
             high = cell_at(level, grain.centre + reach);
  // Runs of cells along the first axis; the others count up like a clock.
  Cell at = low;
  while (true) {
    const int begin = number_of(level, at), last = begin + high[0] - low[0];
    const int first = std::clamp(least, begin, last + 1);
    for (int k = level.start[first]; k < level.start[last + 1]; ++k) {
      const int j = level.members[k];
      const Reach<D>& b = grains_[j];
      const double sum = grain.reach + b.reach;
      if ((b.centre - grain.centre).squaredNorm() < sum * sum) visit(j);
    }
    int axis = 1;
    for (; axis < D && at[axis] == high[axis]; ++axis) at[axis] = low[axis];
    if (axis == D) return;
    ++at[axis];
  }
}

template <int D>
void HierarchicalGrid<D>::near(const Reach<D>& grain, std::vector<int>& found) const {
  const auto first = static_cast<std::ptrdiff_t>(found.size());
  for (const Level& level : levels_) {
    if (!level.members.empty()) {
      visit_cells(level, grain, 0, [&](int j) {
        if (!(grain.fixed && grains_[j].fixed)) found.push_back(j);
      });
    }
  }
  std::sort(found.begin() + first, found.end());
}

template <int D>
void HierarchicalGrid<D>::pairs(std::vector<std::pair<int, int>>& pairs) const {
  pairs.clear();
  const int n = static_cast<int>(grains_.size());
  for (int i = 0; i < n; ++i) {
    const Reach<D>& a = grains_[i];
    for (int l = level_of_[i]; l < static_cast<int>(levels_.size()); ++l) {
      const Level& level = levels_[l];
      if (level.members.empty()) continue;
      // Of two of one level the one in the earlier cell finds the other.
      const bool own = l == level_of_[i];
      visit_cells(level, a, own ? cell_of_[i] : 0, [&](int j) {
        if (own && j <= i && cell_of_[j] == cell_of_[i]) return;
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

template <int D>
std::vector<int> HierarchicalGrid<D>::order() const {
  std::vector<int> order(grains_.size());
  if (grains_.empty()) return order;
  const Level& level = levels_.front();
  // From the axis with the fewest cells to that with the most.
  std::array<int, D> axes;
  for (int a = 0; a < D; ++a) axes[a] = D - 1 - a;
  std::stable_sort(axes.begin(), axes.end(),
                   [&](int a, int b) { return level.count[a] < level.count[b]; });
  std::vector<std::pair<std::int64_t, int>> keyed(grains_.size());
  for (std::size_t i = 0; i < grains_.size(); ++i) {
    const Cell cell = cell_at(level, grains_[i].centre);
    std::int64_t key = cell[axes[D - 1]];
    for (int k = D - 2; k >= 0; --k) key = cell[axes[k]] + key * level.count[axes[k]];
    keyed[i] = {key, static_cast<int>(i)};
  }
  std::sort(keyed.begin(), keyed.end());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].second;
  return order;
}

template class HierarchicalGrid<2>;
template class HierarchicalGrid<3>;

}  // namespace grainfield::dem
