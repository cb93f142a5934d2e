// The free surface of a heap on the floor y = 0, and what is read off it.
#pragma once
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Highest point of the grains in each of equal columns; 0 (the floor) where there is none.
struct Surface {
  double left = 0;    ///< left end of the first column, m
  double column = 0;  ///< width of a column, m
  std::vector<double> top;

  double middle(std::size_t k) const { return left + (static_cast<double>(k) + 0.5) * column; }
};

/// The surface of the free grains of a snapshot: exactly the highest point that a grain, cut at
/// the column's ends, has in that column. `column`: width, m, above 0.
Surface free_surface(const dem::Snapshot& snapshot, double column);

/// A straight line y = at_zero + slope x fitted to a flank.
struct FlankLine {
  double slope = 0;        ///< -
  double at_zero = 0;      ///< m
  double slope_error = 0;  ///< standard error of the slope from the scatter about the line
  int columns = 0;         ///< that were used; below 5: everything is nan
};

/// What a heap looks like. nan where the heap has too few columns for it.
struct HeapShape {
  double height = 0;     ///< m; highest point of the heap
  double apex_x = 0;     ///< m; where the flanks' lines meet, if above the floor between the feet
  double foot_left = 0;  ///< m; where the left flank's line meets the floor
  double foot_right = 0;
  double repose_left_deg = 0, repose_right_deg = 0;              ///< slopes of the flanks
  double repose_left_error_deg = 0, repose_right_error_deg = 0;  ///< standard errors
  FlankLine left, right;

  double half_base_left() const { return apex_x - foot_left; }
  double half_base_right() const { return foot_right - apex_x; }
};

/// Fits each flank by the Theil-Sen line (median slope of all pairs of columns; up to 29 % of
/// outliers leave it alone) over the columns where that line lies between 15 % and 85 % of the
/// height: grains that have rolled off and the rounded top are left out, and no column is chosen by
/// its own height, which would flatten the line.
HeapShape measure_heap(const Surface& surface);

/// A stretch of the x axis, m.
struct Stretch {
  double left = 0, right = 0;
  double length() const { return right - left; }
};

/// Line source (Roul 3.1.2): the part of `last`, where the last layer fell, that is still a
/// plateau: between the outermost columns that are not more than `drop` below the median of all.
/// The plateau; its length is 0 when no column lies in `last`.
Stretch plateau_of(const Surface& surface, const Stretch& last, double drop);

}  // namespace grainfield::coupling
