// Snapshots from files to one averaged field.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/balance.h"
#include "coupling/store/field_io.h"
#include "coupling/tasks/snapshot_names.h"

namespace grainfield::coupling {

struct AverageRequest {
  std::vector<SnapshotName> snapshots;
  bool response = false;   ///< loaded - unloaded of the pairs PREFIX/unloaded, PREFIX/loaded
  AverageOptions options;  ///< width 0: one mean diameter (RVE methods: 2.5)
  /// "layer": models' frame, load or middle at x = 0, surface at y = 0, m. "heap": origin at the
  /// apex, in units of each heap's own height (points.h, cone.h). "packing": the packing's own
  /// axes, m. In space the frames' x and y are horizontal, z up.
  std::string frame = "layer";
  /// Which way is up: "y", "-z" and so on; empty: against the packing's gravity, or its load
  /// (upright.h). In the frames layer and heap the field's last axis is up whatever the packing's.
  std::string up;
  /// In the frame; or empty. With `rings`: radius and height, n x 2.
  Eigen::MatrixXd points;
  std::vector<double> cuts;  ///< horizontal cuts, as shares of the height above the floor, nx
                             ///< (in space nx x ny) points each; used where points is empty
  /// Grid over the packing, where points and cuts are empty; nz in space, where rings are not asked
  /// for (there radius and height have nx and ny). 0: 81 x 31, in space 31 x 31 x 21.
  int nx = 0, ny = 0, nz = 0;
  bool rings = false;        ///< in space: averages over rings about the frame's axis (rings.h)
  std::vector<double> axis;  ///< x, y of that axis in frame "packing", m; empty: the middle
};

/// What a user gave of an averaging, checked and completed, before run_average(): the kernel of
/// the method where none was chosen, a width above 0 where one was, cuts within 0 and 1. Throws
/// std::invalid_argument naming the option.
void settle(AverageRequest& request, bool kernel_chosen, bool width_chosen);

/// Mean and standard error over the snapshots (or pairs), in the frame: field "average" or
/// "response", and with a response in the layer's frame also "base_response"; of several
/// realizations with the single values of the stresses. Attributes: method, kernel, width, h, F
/// where a load is known, and of heaps, one number per realization separated by commas: heap.h (m),
/// rho_g_h (N/m; in space Pa), left_deg, right_deg (of a cone alike), and those of forces of a
/// Python function that made the first packing (added_forces_mark.h). `gaps` (may be null) is told
/// which points have no value, `warnings` (may be null) of states without contacts or whose
/// contacts pull, of such forces, of packings of unlike heights, and of a response without a load.
/// Throws std::invalid_argument for snapshots without a partner, different loads, an unknown frame,
/// snapshots of two and of three dimensions together, rings in the plane, a grid or points of
/// another dimension, and what averaging throws.
NamedFields run_average(AverageRequest request, Gaps* gaps = nullptr,
                        std::vector<std::string>* warnings = nullptr);

/// The balance of methods as Markdown, a row a method.
std::string balance_markdown(const std::vector<BalanceRow>& rows);

}  // namespace grainfield::coupling
