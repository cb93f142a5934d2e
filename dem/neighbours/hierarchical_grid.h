// Neighbour search for mixed sizes, linear in grains, in two or three dimensions.
//
// A grain belongs to the finest level whose cells are at least as wide as its diameter (with the
// gap it keeps); cells double from level to level, up to that of the largest grain. A grain looks
// for partners on its own level and all coarser ones: there are as many levels as octaves of size,
// and per level at most three cells to visit along each axis. Within a level, grains are binned by
// counting sort, so nothing depends on memory addresses.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "dem/space/space.h"

namespace grainfield::dem {

/// A grain as the search sees it.
template <int D>
struct Reach {
  PlainVector<D> centre = PlainVector<D>::Zero();  ///< m
  double reach = 0;                                ///< radius and the gap that it keeps, m
  bool fixed = false;                              ///< never partner of another fixed one
};

using IndexPairs = std::vector<std::pair<int, int>>;

template <int D>
class HierarchicalGrid {
 public:
  /// Bins the grains and keeps a copy of them.
  void build(std::span<const Reach<D>> grains);

  /// Every pair (i < j) that is closer than the sum of its reaches, fixed-fixed pairs left out,
  /// sorted by (i, j), into `pairs`.
  void pairs(IndexPairs& pairs) const;

  /// The same in parts, by several threads. Each pair is found by one of its two grains: those of
  /// grains [first, last), into `found`.
  void find_pairs(int first, int last, IndexPairs& found) const;
  /// Sorts the found pairs whose first grain is in [first, last) into `sorted`.
  static void sort_pairs(std::span<const std::span<const std::pair<int, int>>> found, int first,
                         int last, IndexPairs& sorted);

  /// Appends the indices of all binned grains that are closer to `grain` than the sum of the
  /// reaches, ascending.
  void near(const Reach<D>& grain, std::vector<int>& found) const;

  /// Order of these grains by rows of cells as wide as the smallest grain, rows along the shortest
  /// side of the packing and layers along the next one (ties by index): neighbours in space become
  /// neighbours in memory, and what a sweep needs of the next row stays in cache.
  static std::vector<int> order(std::span<const Reach<D>> grains);

 private:
  using Cell = std::array<int, D>;
  struct Level {
    double cell = 0;
    Cell count{};                   // of cells along each axis
    std::vector<int> start;         // of each cell in `members`
    std::vector<int> members;       // grain indices, ascending within a cell
    std::vector<Reach<D>> reaches;  // of the members
  };
  /// The box of all centres.
  struct Box {
    PlainVector<D> low = PlainVector<D>::Zero(), extent = PlainVector<D>::Zero();
    double least = 0, most = 0;  ///< reach
    double grains = 0;           ///< how many

    explicit Box(std::span<const Reach<D>> grains);
    Box() = default;
    /// A cell's edge, or a larger one where there would be too many cells.
    double widened(double edge) const;
    Cell count_of(double edge) const;
    Cell cell_at(double edge, const Cell& count, const PlainVector<D>& at) const;
  };
  Cell cell_at(const Level& level, const PlainVector<D>& at) const {
    return box_.cell_at(level.cell, level.count, at);
  }
  /// Number of a cell: the first axis runs fastest.
  static int number_of(const Level& level, const Cell& cell);
  /// visit(j) for those of a level that meet the grain, in cells numbered `least` and above.
  template <class Visit>
  void visit_cells(const Level& level, const Reach<D>& grain, int least, Visit visit) const;

  Box box_;
  std::vector<Reach<D>> grains_;
  std::vector<Level> levels_;
  std::vector<unsigned char> level_of_;
  std::vector<int> cell_of_, cursor_;
};

extern template class HierarchicalGrid<2>;
extern template class HierarchicalGrid<3>;

}  // namespace grainfield::dem
