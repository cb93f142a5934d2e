// Where a packing lies in the frame in which fields are given.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>

#include "coupling/specimen/pile_frame.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// From a frame to the packing's axes, and the packing's extents in that frame.
struct Placement {
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)> to_packing;
  double left = 0, right = 0;  ///< m; in frame "heap" over its height
  double depth = 0;            ///< height of the layer or heap, m
  PileFrame heap = {};         ///< frame "heap" only; of a cone both flanks alike
  double front = 0, back = 0;  ///< in space: as left and right, along y
};

/// Throws std::invalid_argument with the nearest name unless it is layer, heap or packing.
void require_frame(const std::string& frame);

/// `loaded_grain`: id of the grain below which x = 0 (in space also y = 0) lies in frame "layer";
/// -1: the snapshot's own, or without one the middle. Of spheres: layer.h and cone.h. Throws
/// std::invalid_argument where the packing has no layer or heap to be measured.
Placement place(const dem::Snapshot& snapshot, const std::string& frame,
                std::int64_t loaded_grain = -1);

/// A rectangle (in space a box) over a packing, in the frame.
struct Span {
  double left = 0, right = 0, bottom = 0, top = 0;
  double front = 0, back = 0;  ///< in space

  Eigen::MatrixXd grid(int columns, int rows) const;
  /// In space, x fastest, then y.
  Eigen::MatrixXd grid(int columns, int rows, int layers) const;
};

/// `sides`: left, right, front and back, which it keeps.
Span span_of(const dem::Snapshot& snapshot, const std::string& frame, const Span& sides,
             double depth);

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
