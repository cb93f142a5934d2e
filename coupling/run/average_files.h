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
  AverageOptions options;  ///< width 0: one mean diameter (particle_centre: 2.5)
  Eigen::MatrixXd points;  ///< models' frame (load or middle at x = 0, surface at y = 0); or empty
  int nx = 81, ny = 31;    ///< grid over the layer, where points is empty
};

/// Mean and standard error over the snapshots (or pairs), in the models' frame: field "average" or
/// "response", and with a response also "base_response". Attributes: method, kernel, width, h, and
/// F where a load is known. Throws std::invalid_argument for snapshots without a partner, different
/// loads, and what averaging throws.
NamedFields average_files(AverageRequest request);

}  // namespace grainfield::coupling
