// A finished realization in one HDF5 file: one group per snapshot ("/unloaded"). The order of the
// snapshots and the figures stand in their attributes: "realization:order" in each, and of the
// first one "figure:NAME" with all digits.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "coupling/averaging/layer.h"
#include "dem/run/run.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// A finished realization as it stands in its file.
struct Realization {
  std::vector<std::pair<std::string, dem::Snapshot>> snapshots;  ///< by name, as the run left them
  std::map<std::string, double> figures;

  /// The snapshot of that name, or null.
  const dem::Snapshot* find(const std::string& name) const;
  /// The same; throws std::invalid_argument naming those there are.
  const dem::Snapshot& operator[](const std::string& name) const;
};

/// Complete or not at all. A result needs at least one snapshot.
void write_realization(const std::string& file, const dem::RunResult& result);
/// Throws std::invalid_argument naming the file when it is broken.
Realization read_realization(const std::string& file);

/// The mean of the layers in these files, which hold the states "unloaded" and "loaded".
MeanLayer mean_layer(const std::vector<std::string>& files);

}  // namespace grainfield::coupling
