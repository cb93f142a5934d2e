// Neighbour search for mixed sizes, linear in grains.
//
// A grain belongs to the finest level whose cells are at least as wide as its diameter (with the
// gap it keeps); cells double from level to level. A grain looks for partners on its own level and
// all coarser ones: there are as many levels as octaves of size, and per level at most 3 x 3 cells
// to visit. Within a level, grains are binned by counting sort, so nothing depends on memory
// addresses.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace grainfield::dem {

/// A grain as the search sees it.
struct Reach {
  double x = 0, y = 0;
  double reach = 0;    ///< radius and the gap that it keeps, m
  bool fixed = false;  ///< never partner of another fixed one
};

class HierarchicalGrid {
 public:
  /// Bins the grains and keeps a copy of them.
  void build(std::span<const Reach> grains);

  /// Every pair (i < j) that is closer than the sum of its reaches, fixed-fixed pairs left out,
  /// sorted by (i, j), into `pairs`.
  void pairs(std::vector<std::pair<int, int>>& pairs) const;

  /// Appends the indices of all binned grains that are closer to `grain` than the sum of the
  /// reaches, ascending.
  void near(const Reach& grain, std::vector<int>& found) const;

  /// Order of the grains by rows of the finest level's cells, rows along the shorter side of the
  /// packing (ties by index): neighbours in space become neighbours in memory, and what a sweep
  /// needs of the next row stays in cache.
  std::vector<int> order() const;

 private:
  struct Level {
    double cell = 0;
    int nx = 0, ny = 0;
    std::vector<int> start;    // of each cell in `members`
    std::vector<int> members;  // grain indices, ascending within a cell
  };
  int column(const Level& level, double x) const;
  int row(const Level& level, double y) const;
  template <class Visit>
  void visit_cells(const Level& level, const Reach& grain, Visit visit) const;

  double x0_ = 0, y0_ = 0, finest_ = 0;
  std::vector<Reach> grains_;
  std::vector<Level> levels_;
  std::vector<unsigned char> level_of_;
  std::vector<int> cell_of_, cursor_;
};

}  // namespace grainfield::dem
