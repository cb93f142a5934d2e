// The two ways of averaging, and what they share. Used by average.cc only.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/point_cells.h"

namespace grainfield::coupling {

/// Sums per point, in the order of the columns of average(); density-like ones per area.
enum Sum {
  kXX,
  kYY,
  kXY,
  kYX,  // contact stress: force, branch
  kMass,
  kVolume,  // density, volume fraction
  kMomentumX,
  kMomentumY,  // momentum density
  kFluxXX,
  kFluxYY,
  kFluxXY,  // density of m v v
  kTractionX,
  kTractionY,
  kLoadX,
  kLoadY,
  kGrains,
  kSums
};
using Sums = Eigen::Matrix<double, Eigen::Dynamic, kSums, Eigen::RowMajor>;

/// Adds what the grains give to the points [first, last) into `sums` (one row per point). Points
/// where the weight has no meaning become nan.
using AddBand = void (*)(const dem::Snapshot&, const LayerFrame&, const Eigen::MatrixXd& points,
                         Eigen::Index first, Eigen::Index last, const AverageOptions&, Sums&);

void add_coarse_graining(const dem::Snapshot&, const LayerFrame&, const Eigen::MatrixXd& points,
                         Eigen::Index first, Eigen::Index last, const AverageOptions&, Sums&);
void add_particle_centre(const dem::Snapshot&, const LayerFrame&, const Eigen::MatrixXd& points,
                         Eigen::Index first, Eigen::Index last, const AverageOptions&, Sums&);

/// Adds mass, volume, momentum, momentum flux and the applied force of one grain, times `weight`.
void add_grain(const dem::Snapshot&, const dem::Grain&, double weight, Eigen::Index point, Sums&);

/// Names of the supports of particle_centre: "circle", "square".
const std::vector<std::string>& support_names();

}  // namespace grainfield::coupling
