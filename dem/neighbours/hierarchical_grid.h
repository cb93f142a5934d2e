// Neighbour search for mixed sizes, linear in grains, in two or three dimensions.
//
// A grain belongs to the finest level whose cells are at least as wide as its diameter (with the
// gap it keeps); cells double from level to level. A grain looks for partners on its own level and
// all coarser ones: there are as many levels as octaves of size, and per level at most three cells
// to visit along each axis. Within a level, grains are binned by counting sort, so nothing depends
// on memory addresses.
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

template <int D>
class HierarchicalGrid {
 public:
  /// Bins the grains and keeps a copy of them.
  void build(std::span<const Reach<D>> grains);

  /// Every pair (i < j) that is closer than the sum of its reaches, fixed-fixed pairs left out,
  /// sorted by (i, j), into `pairs`.
  void pairs(std::vector<std::pair<int, int>>& pairs) const;

  /// Appends the indices of all binned grains that are closer to `grain` than the sum of the
  /// reaches, ascending.
  void near(const Reach<D>& grain, std::vector<int>& found) const;

  /// Order of the grains by rows of the finest level's cells, rows along the shortest side of the
  /// packing and layers along the next one (ties by index): neighbours in space become neighbours
  /// in memory, and what a sweep needs of the next row stays in cache.
  std::vector<int> order() const;

 private:
  using Cell = std::array<int, D>;
  struct Level {
    double cell = 0;
    Cell count{};              // of cells along each axis
    std::vector<int> start;    // of each cell in `members`
    std::vector<int> members;  // grain indices, ascending within a cell
  };
  Cell cell_at(const Level& level, const PlainVector<D>& at) const;
  /// Number of a cell: the first axis runs fastest.
  static int number_of(const Level& level, const Cell& cell);
  /// visit(j) for those of a level that meet the grain, in cells numbered `least` and above.
  template <class Visit>
  void visit_cells(const Level& level, const Reach<D>& grain, int least, Visit visit) const;

  PlainVector<D> low_ = PlainVector<D>::Zero();
  double finest_ = 0;
  std::vector<Reach<D>> grains_;
  std::vector<Level> levels_;
  std::vector<unsigned char> level_of_;
  std::vector<int> cell_of_, cursor_;
};

extern template class HierarchicalGrid<2>;
extern template class HierarchicalGrid<3>;

}  // namespace grainfield::dem
