// Neighbour search for mixed sizes, linear in grains.
//
// A grain belongs to the finest level whose cells are at least as wide as its diameter plus skin;
// cells double from level to level. A grain looks for partners on its own level and all coarser
// ones: there are as many levels as octaves of size, and per level at most 3 x 3 cells to visit.
// Within a level, grains are binned by counting sort, so nothing depends on memory addresses.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "dem/engine/body.h"

namespace grainfield::dem {

class HierarchicalGrid {
 public:
  /// Bins the grains. `skin`: gap between surfaces up to which two grains are partners, m.
  void build(std::span<const Body> bodies, double skin);

  /// Appends every pair (i < j) with a gap of at most the skin, fixed-fixed pairs left out, to
  /// `pairs`, sorted by (i, j).
  void pairs(std::span<const Body> bodies, std::vector<std::pair<int, int>>& pairs) const;

  /// Order of the grains by rows of the finest level's cells, rows along the shorter side of the
  /// packing (ties by index): neighbours in space become neighbours in memory, and what a sweep
  /// needs of the next row stays in cache. Valid after build().
  std::vector<int> order(std::span<const Body> bodies) const;

 private:
  struct Level {
    double cell = 0;
    int nx = 0, ny = 0;
    std::vector<int> start;    // of each cell in `members`
    std::vector<int> members;  // grain indices, ascending within a cell
  };
  int column(const Level& level, double x) const;
  int row(const Level& level, double y) const;

  double skin_ = 0, x0_ = 0, y0_ = 0, finest_ = 0;
  std::vector<Level> levels_;
  std::vector<unsigned char> level_of_;
};

}  // namespace grainfield::dem
