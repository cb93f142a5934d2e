// Which grains are near each other: a grid of cells at least as wide as the largest grain, so that
// grains touch only within a cell or across to one beside it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "dem/space/elementary.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

/// A rectangle or cuboid. Along an axis that repeats, what leaves on one side comes in on the
/// other; along others space goes on, and walls bound it.
template <int D>
struct HardBox {
  VectorOf<D> low = zero<VectorOf<D>>();   ///< corner, m
  VectorOf<D> size = zero<VectorOf<D>>();  ///< above 0, m
  std::array<bool, D> periodic{};
};

template <int D>
class Cells {
 public:
  using Vector = VectorOf<D>;
  static constexpr std::int32_t kNone = -1;

  Cells() = default;
  /// At least `width` (m) wide cells, about kCellsPerGrain for each of `grains` or fewer. The box
  /// is finite, and at least three widths along the axes that repeat.
  Cells(const HardBox<D>& box, double width, std::size_t grains)
      : box_(box), next_(grains, kNone), last_(grains, kNone) {
    double volume = 1;
    for (int a = 0; a < D; ++a) volume *= box.size[a];
    const double most = kCellsPerGrain * static_cast<double>(std::max<std::size_t>(grains, 1));
    const double even = D == 2 ? std::sqrt(volume / most) : cube_root(volume / most);
    const double wide = std::max(width * (1 + kSpare), even);
    int count = 1;
    for (int a = 0; a < D; ++a) {
      const int least = box.periodic[a] ? 3 : 1;
      counts_[a] = std::max(least, static_cast<int>(std::min(box.size[a] / wide, kMostAlong)));
      widths_[a] = box.size[a] / counts_[a];
      strides_[a] = count;
      count *= counts_[a];
    }
    first_.assign(static_cast<std::size_t>(count), kNone);
    set_near();
  }

  std::size_t grains() const { return next_.size(); }
  /// Takes all grains out.
  void clear() { std::fill(first_.begin(), first_.end(), kNone); }

  std::int32_t count() const { return static_cast<std::int32_t>(first_.size()); }
  /// The cell of a place; beyond the ends of an axis that does not repeat its last cell.
  std::int32_t of(const Vector& place) const {
    std::int32_t cell = 0;
    for (int a = 0; a < D; ++a) {
      const double at = std::floor((place[a] - box_.low[a]) / widths_[a]);
      cell += strides_[a] * static_cast<std::int32_t>(std::clamp(at, 0.0, counts_[a] - 1.0));
    }
    return cell;
  }
  void put(std::int32_t grain, std::int32_t cell) {
    const std::int32_t front = first_[cell];
    next_[grain] = front;
    last_[grain] = kNone;
    if (front != kNone) last_[front] = grain;
    first_[cell] = grain;
  }
  void take(std::int32_t grain, std::int32_t cell) {
    const std::int32_t before = last_[grain], after = next_[grain];
    (before == kNone ? first_[cell] : next_[before]) = after;
    if (after != kNone) last_[after] = before;
  }

  /// A cell's lower and upper face across an axis, m; infinite where the last cell goes on.
  std::array<double, 2> faces(std::int32_t cell, int axis) const {
    const int at = along(cell, axis);
    const bool ends = !box_.periodic[axis];
    const double low = box_.low[axis] + at * widths_[axis];
    return {ends && at == 0 ? -kEndless : low,
            ends && at + 1 == counts_[axis] ? kEndless : low + widths_[axis]};
  }
  /// The cell beside along an axis (`way` -1 or 1), and by how much places have to be moved, m, to
  /// come in on the other side; 0: they stay.
  struct Beside {
    std::int32_t cell = 0;
    double shift = 0;
  };
  Beside beside(std::int32_t cell, int axis, int way) const {
    const int at = along(cell, axis), to = at + way;
    const double size = box_.size[axis];
    if (to < 0) return {cell + strides_[axis] * (counts_[axis] - 1), size};
    if (to == counts_[axis]) return {cell - strides_[axis] * at, -size};
    return {cell + strides_[axis] * way, 0};
  }

  /// visit(grain, shift): the grains of the cell and of those beside it; at their place + shift
  /// they are near.
  template <class Visit>
  void near(std::int32_t cell, Visit visit) const {
    visit_cells(cell, all_, visit);
  }
  /// The same of the cells that are near after a step along the axis and were not before it.
  template <class Visit>
  void near_after(std::int32_t cell, int axis, int way, Visit visit) const {
    visit_cells(cell, ahead_[axis][way > 0 ? 1 : 0], visit);
  }

 private:
  static constexpr double kCellsPerGrain = 2;  // 1 takes a seventh longer, 1/2 nearly twice
  static constexpr double kSpare = 1e-9;       // beyond round-off of places
  static constexpr double kMostAlong = 1e4;
  static constexpr double kEndless = std::numeric_limits<double>::infinity();

  using Way = std::array<std::int8_t, D>;
  struct Near {
    std::vector<Way> ways;
    std::vector<std::int32_t> steps;  // in cells' numbers, away from the box's sides
  };

  int along(std::int32_t cell, int axis) const { return cell / strides_[axis] % counts_[axis]; }
  void set_near() {
    const auto add = [&](Near& near, const Way& way) {
      std::int32_t step = 0;
      for (int a = 0; a < D; ++a) step += strides_[a] * way[a];
      near.ways.push_back(way);
      near.steps.push_back(step);
    };
    const int ways = D == 2 ? 9 : 27;
    for (int k = 0; k < ways; ++k) {
      Way way{};
      for (int a = 0, rest = k; a < D; ++a, rest /= 3)
        way[a] = static_cast<std::int8_t>(rest % 3 - 1);
      add(all_, way);
      for (int a = 0; a < D; ++a) {
        if (way[a] != 0) add(ahead_[a][way[a] > 0 ? 1 : 0], way);
      }
    }
    inner_.assign(first_.size(), 1);
    for (std::int32_t c = 0; c < count(); ++c) {
      for (int a = 0; a < D; ++a) {
        const int at = along(c, a);
        if (at == 0 || at + 1 == counts_[a]) inner_[c] = 0;
      }
    }
  }
  template <class Visit>
  void visit_cell(std::int32_t cell, const Vector& shift, Visit& visit) const {
    for (std::int32_t g = first_[cell]; g != kNone; g = next_[g]) visit(g, shift);
  }
  template <class Visit>
  void visit_cells(std::int32_t cell, const Near& near, Visit& visit) const {
    const Vector none = Vector::Zero();
    if (inner_[cell] != 0) {
      for (const std::int32_t step : near.steps) visit_cell(cell + step, none, visit);
      return;
    }
    for (const Way& way : near.ways) {
      std::int32_t other = cell;
      Vector shift = none;
      bool there = true;
      for (int a = 0; a < D && there; ++a) {
        const int to = along(cell, a) + way[a];
        other += strides_[a] * way[a];
        if (to >= 0 && to < counts_[a]) continue;
        there = box_.periodic[a];
        const int turns = to < 0 ? -1 : 1;
        other -= turns * strides_[a] * counts_[a];
        shift[a] = turns * box_.size[a];
      }
      if (there) visit_cell(other, shift, visit);
    }
  }

  HardBox<D> box_;
  std::array<int, D> counts_{}, strides_{};
  std::array<double, D> widths_{};
  std::vector<std::int32_t> first_, next_, last_;
  std::vector<char> inner_;
  Near all_;
  std::array<std::array<Near, 2>, D> ahead_;
};

}  // namespace grainfield::dem
