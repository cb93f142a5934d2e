// Snapshots from files to one averaged field.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/output/field_io.h"

namespace grainfield::coupling {

/// A snapshot in a file.
struct SnapshotName {
  std::string file, group;
};

/// "FILE.h5" (every snapshot of the file) or "FILE.h5:group". Throws std::invalid_argument.
std::vector<SnapshotName> parse_snapshot_names(const std::vector<std::string>& texts);

struct AverageRequest {
  std::vector<SnapshotName> snapshots;
  bool response = false;   ///< loaded - unloaded of the pairs PREFIX/unloaded, PREFIX/loaded
  AverageOptions options;  ///< width 0: one mean diameter (RVE methods: 2.5)
  /// "layer": models' frame, load or middle at x = 0, surface at y = 0, m. "heap": origin at the
  /// apex, in units of each heap's own height (points.h). "packing": the packing's own axes, m.
  std::string frame = "layer";
  Eigen::MatrixXd points;    ///< in the frame; or empty
  std::vector<double> cuts;  ///< horizontal cuts, as shares of the height above the floor, nx
                             ///< points each; used where points is empty
  int nx = 81, ny = 31;      ///< grid over the packing, where points and cuts are empty
};

/// Mean and standard error over the snapshots (or pairs), in the frame: field "average" or
/// "response", and with a response in the layer's frame also "base_response"; of several
/// realizations with the single values of the stresses. Attributes: method, kernel, width, h, F
/// where a load is known, and of heaps, one number per realization separated by commas: heap.h (m),
/// rho_g_h (N/m), left_deg, right_deg. `gaps` (may be null) is told which points have no
/// value, `warnings` (may be null) of states without contacts or whose contacts pull, of packings
/// of unlike heights, and of a response without a load. Throws std::invalid_argument for snapshots
/// without a partner, different loads, an unknown frame, 3D snapshots without points in the
/// packing's frame, and what averaging throws.
NamedFields average_files(AverageRequest request, Gaps* gaps = nullptr,
                          std::vector<std::string>* warnings = nullptr);

}  // namespace grainfield::coupling
