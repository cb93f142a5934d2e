// The mean stress of a packing, in one line.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Volume that the packing fills, m3 (2D: area, m2): of a cell that repeats along every axis the
/// cell, else what is above the floor, between the sides and below the free surface or the lid
/// (averaging/region.h). The last axis must be up. Throws std::invalid_argument without a free
/// grain.
double packing_volume(const dem::Snapshot& snapshot);

/// Sum over the free grains' contacts of force (outer) arm from the centroid, over packing_volume,
/// without its antisymmetric part; tension positive, Pa (2D: N/m).
Eigen::Matrix3d mean_stress(const dem::Snapshot& snapshot);

/// "sigma_xx -12.30 ± 0.50, sigma_yy ... N/m (tension positive, 4 packings)": mean and standard
/// error over packings of one dimension; of a single one without an error.
std::string mean_stress_text(const std::vector<Eigen::Matrix3d>& packings, int dim);

}  // namespace grainfield::coupling
