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
// Looked at together.
constexpr int kMostHits = 32;

}  // namespace

template <int D>
HierarchicalGrid<D>::Box::Box(std::span<const Reach<D>> grains_in)
    : grains(static_cast<double>(grains_in.size())) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  least = inf;
  low.setConstant(inf);
  PlainVector<D> high = PlainVector<D>::Constant(-inf);
  for (const Reach<D>& g : grains_in) {
    low = low.cwiseMin(g.centre);
    high = high.cwiseMax(g.centre);
    least = std::min(least, g.reach);
    most = std::max(most, g.reach);
  }
  extent = high - low;
}

template <int D>
auto HierarchicalGrid<D>::Box::cell_at(double edge, const Cell& count,
                                       const PlainVector<D>& at) const -> Cell {
  Cell cell;
  for (int a = 0; a < D; ++a) {
    cell[a] = static_cast<int>(std::clamp((at[a] - low[a]) / edge, 0.0, count[a] - 1.0));
  }
  return cell;
}

template <int D>
double HierarchicalGrid<D>::Box::widened(double edge) const {
  const double limit = kMaxCellsPerGrain * grains + 64;
  while ((extent.array() / edge + 1).prod() > limit) edge *= 1.5;
  return edge;
}

template <int D>
auto HierarchicalGrid<D>::Box::count_of(double edge) const -> Cell {
  Cell count;
  for (int a = 0; a < D; ++a) count[a] = static_cast<int>(extent[a] / edge) + 1;
  return count;
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
  box_ = Box(grains);
  // Cells of the largest grains are no wider than they have to be.
  double finest = 2 * box_.most;
  int count = 1;
  for (; count < kMaxLevels && finest >= 4 * box_.least; ++count) finest /= 2;
  const double wide = box_.widened(finest);
  for (; count > 1 && std::ldexp(wide, count - 2) >= 2 * box_.most; --count) {
  }
  levels_.resize(count);
  for (int l = 0; l < count; ++l) {
    Level& level = levels_[l];
    level.cell = std::ldexp(wide, l);
    level.count = box_.count_of(level.cell);
    std::size_t number = 1;
    for (const int along : level.count) number *= static_cast<std::size_t>(along);
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
    level.reaches.resize(level.members.size());
    cursor_.assign(level.start.begin(), level.start.end());
    for (int i = 0; i < n; ++i) {
      if (level_of_[i] != l) continue;
      const int at = cursor_[cell_of_[i]]++;
      level.members[at] = i;
      level.reaches[at] = grains[i];
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
    const int end = level.start[last + 1];
    for (int from = level.start[first]; from < end; from += kMostHits) {
      // Without a branch: who is near follows no pattern.
      int hits[kMostHits], count = 0;
      for (int k = from; k < std::min(from + kMostHits, end); ++k) {
        const Reach<D>& b = level.reaches[k];
        const double sum = grain.reach + b.reach;
        hits[count] = level.members[k];
        count += (b.centre - grain.centre).squaredNorm() < sum * sum ? 1 : 0;
      }
      for (int h = 0; h < count; ++h) visit(hits[h]);
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
void HierarchicalGrid<D>::find_pairs(int first, int last, IndexPairs& found) const {
  found.clear();
  for (int i = first; i < last; ++i) {
    const Reach<D>& a = grains_[i];
    for (int l = level_of_[i]; l < static_cast<int>(levels_.size()); ++l) {
      const Level& level = levels_[l];
      if (level.members.empty()) continue;
      // The one in the earlier cell finds the other of two of one level.
      const bool own = l == level_of_[i];
      visit_cells(level, a, own ? cell_of_[i] : 0, [&](int j) {
        if (own && j <= i && cell_of_[j] == cell_of_[i]) return;
        if (a.fixed && grains_[j].fixed) return;
        found.emplace_back(std::min(i, j), std::max(i, j));
      });
    }
  }
}

template <int D>
void HierarchicalGrid<D>::sort_pairs(std::span<const std::span<const std::pair<int, int>>> found,
                                     int first, int last, IndexPairs& sorted) {
  // Counting sort by the first, then each short row by the second.
  const auto visit = [&](auto act) {
    for (const auto& some : found) {
      for (const auto& pair : some) {
        if (first <= pair.first && pair.first < last) act(pair);
      }
    }
  };
  std::vector<int> start(static_cast<std::size_t>(last - first) + 1, 0);
  visit([&](const auto& pair) { ++start[pair.first - first + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  sorted.resize(static_cast<std::size_t>(start.back()));
  std::vector<int> next(start);
  visit([&](const auto& pair) { sorted[next[pair.first - first]++] = pair; });
  for (std::size_t i = 0; i + 1 < start.size(); ++i) {
    std::sort(sorted.begin() + start[i], sorted.begin() + start[i + 1]);
  }
}

template <int D>
void HierarchicalGrid<D>::pairs(IndexPairs& pairs) const {
  const int n = static_cast<int>(grains_.size());
  IndexPairs found;
  find_pairs(0, n, found);
  const std::span<const std::pair<int, int>> all[] = {found};
  sort_pairs(all, 0, n, pairs);
}

template <int D>
std::vector<int> HierarchicalGrid<D>::order(std::span<const Reach<D>> grains) {
  std::vector<int> order(grains.size());
  if (grains.empty()) return order;
  // Not by the cells of a level: this order decides the order of sums, and so their bits.
  const Box box(grains);
  const double edge = box.widened(2 * box.least);
  const Cell count = box.count_of(edge);
  // From the axis with the fewest cells to that with the most.
  std::array<int, D> axes;
  for (int a = 0; a < D; ++a) axes[a] = D - 1 - a;
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return count[a] < count[b]; });
  std::vector<std::pair<std::int64_t, int>> keyed(grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const Cell cell = box.cell_at(edge, count, grains[i].centre);
    std::int64_t key = cell[axes[D - 1]];
    for (int k = D - 2; k >= 0; --k) key = cell[axes[k]] + key * count[axes[k]];
    keyed[i] = {key, static_cast<int>(i)};
  }
  std::sort(keyed.begin(), keyed.end());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].second;
  return order;
}

template class HierarchicalGrid<2>;
template class HierarchicalGrid<3>;

}  // namespace grainfield::dem
