// Samples of a neighbourhood, realization by realization, and their reduction to a draw.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/elastic_constants/constants.h"

namespace grainfield::coupling {

/// Stress and strain at one point, with its weight and its place relative to the centre.
struct Sample {
  Eigen::Vector2d offset{0, 0};  ///< from the centre, m
  double weight = 0;
  Eigen::Vector3d stress{0, 0, 0}, strain{0, 0, 0};  ///< xx, yy, xy
};

/// Of one realization: points with a weight above 0 and no nan; `point` tells them apart.
struct Samples {
  std::vector<Sample> list;
  std::vector<Eigen::Index> point;
};

/// One entry per realization. Throws as check_increments().
std::vector<Samples> gather(const Increments& increments, const Locality& where);

/// At each point the mean over the chosen realizations that have it, weight unchanged, in the
/// order of the points.
std::vector<Sample> mean_samples(const std::vector<Samples>& all, const std::vector<int>& chosen,
                                 Eigen::Index points);

/// Throws std::invalid_argument unless options.samples and options.degree are known.
void check_options(const ElasticOptions& options);

/// As a Constant: value, error and ends.
inline Constant constant_of(const BootstrapInterval& interval) {
  return {interval.value, interval.error, interval.low, interval.high};
}

}  // namespace grainfield::coupling
