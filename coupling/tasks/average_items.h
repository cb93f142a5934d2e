// The packings of an averaging: their states, which way is up in each, and how far they reach.
#pragma once
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "coupling/specimen/pile_frame.h"
#include "coupling/tasks/average_task.h"

namespace grainfield::coupling {

/// A state, or with a response the loaded state and the unloaded one.
struct AveragedItem {
  SnapshotName state, unloaded;
  dem::Vec3 up{0, 0, 0};
};

/// The items of a request; with a response the pairs by what their names have before "/loaded" and
/// "/unloaded". Throws std::invalid_argument for a state without its partner.
std::vector<AveragedItem> averaged_items(const AverageRequest& request);

/// The item's packing as the frame sees it: in frame packing as it is.
std::shared_ptr<const dem::Snapshot> packing_in_frame(const SnapshotName& name,
                                                      const AveragedItem& item,
                                                      const AverageRequest& request);

/// The packings of all snapshots, as one; m, N.
struct AveragedExtents {
  double depth = 0, left = -std::numeric_limits<double>::infinity(),
         right = std::numeric_limits<double>::infinity(), diameter = 0, load = 0;
  double front = -std::numeric_limits<double>::infinity(),
         back = std::numeric_limits<double>::infinity();  // in space
  int dim = 2;
  std::vector<PileFrame> heaps;                                      // frame "heap" only
  double least = std::numeric_limits<double>::infinity(), most = 0;  // of the depths
  Attributes added_forces;  // those of the first packing with such forces
};

/// Measures the items and finds which way is up in each. Throws std::invalid_argument for packings
/// of different dimensions or loads, copies of one packing, and heaps without gravity; `warnings`:
/// what makes their averages mean nothing, or something else than their user thinks.
AveragedExtents measure_items(std::vector<AveragedItem>& items, const AverageRequest& request,
                              std::vector<std::string>& warnings);

}  // namespace grainfield::coupling
