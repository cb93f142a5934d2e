// Periodic packings as averages see them.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// A packing with the images around it, as one without a cell.
struct Surrounded {
  dem::Snapshot snapshot;
  std::vector<std::size_t> source;  ///< of each grain: its index in the original
};

/// All images of grains and contacts that are within `reach` (m) of the box of the points (n x dim)
/// and more. Images in a flowing cell move with it. Throws std::invalid_argument when the points
/// are so far away that images of more than a thousand cells would be needed.
Surrounded surround(const dem::Snapshot& periodic, const Eigen::MatrixXd& points, double reach);

}  // namespace grainfield::coupling
