// The layer as a rectangle (a box in space), and the frame in which continuum models see it: load
// at the origin, inside is y < 0 down to y = -depth (in space z for y).
#pragma once
#include <Eigen/Core>
#include <limits>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Edges of a settled layer in the packing's own axes, m.
struct LayerFrame {
  double left = 0, right = 0;  ///< side walls; without walls the outermost grains' edges
  double floor = 0;            ///< flat floor's height; rough floor: mean height of the contacts
                               ///< between free and fixed grains
  double surface = 0;          ///< mean height of the highest grain edge over columns two mean
                               ///< diameters wide
  double load_x = 0;           ///< abscissa of the loaded grain, or the middle of the layer
  double front = 0, back = 0;  ///< in space: the same as left and right, along y
  double load_y = 0;           ///< in space: y of the loaded grain, or the middle

  double depth() const { return surface - floor; }
  double width() const { return right - left; }
  /// From the models' frame to the packing's axes; n x 2, in space n x 3, m.
  Eigen::MatrixXd to_packing(const Eigen::MatrixXd& model_points) const;
};

/// Measures the layer. Walls: in the plane those named "left", "right", "floor"; in space planes
/// across an axis, whatever their names, and the ends of a cell that repeats along x or y alone.
/// `loaded_grain`: id of the grain that is or will be loaded (for load_x, load_y), -1: the
/// snapshot's own. Throws std::invalid_argument if no free grain is between the sides.
LayerFrame layer_frame(const dem::Snapshot& snapshot, std::int64_t loaded_grain = -1);

/// The loaded layers of an ensemble as one.
struct MeanLayer {
  double depth = 0, force = 0, diameter = 0;  ///< means of h, m, F, N, and the grains' diameter, m
  /// From the load to the nearest side wall (or end of the cell), least of the layers, m.
  double half_width = std::numeric_limits<double>::infinity();

  /// Adds one of `count` layers.
  void add(const dem::Snapshot& unloaded, const dem::Snapshot& loaded, std::size_t count);
};

/// Mean diameter of the free grains, m; the unit in which kernel widths are usually chosen.
double mean_diameter(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
