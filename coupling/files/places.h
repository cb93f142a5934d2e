// Where a field is wanted: how a grid is written, and how much may be asked for.
#pragma once
#include <string>

namespace grainfield::coupling {

struct GridSize {
  int columns = 0, rows = 0, layers = 0;  ///< 0: not asked for
};
/// "COLUMNSxROWS" or "COLUMNSxROWSxLAYERS". Throws std::invalid_argument "--grid: ..." for other
/// texts, fewer than 2 and more than a million points.
GridSize parse_grid(const std::string& text);

/// `points`: how many are given, 0: none. Throws std::invalid_argument "--points: ..." or "--grid:
/// ..." where points times snapshots are more than ten million numbers.
void require_few_places(double points, const GridSize& grid, double snapshots);

}  // namespace grainfield::coupling
