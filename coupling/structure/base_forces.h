// What single grains of the lowest layer put on the base: P(n) of Roul fig. 3.7.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// The free grains that touch the base: a wall named "floor" or a fixed grain, sorted by x.
struct BaseForces {
  std::vector<std::int64_t> ids;
  Eigen::VectorXd x;           ///< m, of the centroids
  Eigen::VectorXd force;       ///< N, vertical part of the base's force on the grain, upwards
  Eigen::VectorXd normalised;  ///< n = force / mean force; nan where the mean is 0
  double mean = 0;             ///< N
};

/// Vertical: against gravity; without gravity y in 2D, z in 3D. The distribution P(n) is
/// density_histogram(normalised, ...), its tail exponential_tail(normalised, 1). Several contacts
/// of a grain with the base are added. Throws std::invalid_argument when no free grain touches a
/// base.
BaseForces base_forces(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
