// Samples of a neighbourhood, realization by realization.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/elastic_constants/constants.h"

namespace grainfield::coupling {

/// Stress and strain at one point, with its weight.
struct Sample {
  double weight = 0;
  Eigen::Vector3d stress{0, 0, 0}, strain{0, 0, 0};  ///< xx, yy, xy
};

/// Points of one realization with a weight above 0 and no nan.
using Samples = std::vector<Sample>;

/// One entry per realization. Throws as check_increments().
std::vector<Samples> gather(const Increments& increments, const Locality& where);

/// As a Constant: value, error and ends.
inline Constant constant_of(const BootstrapInterval& interval) {
  return {interval.value, interval.error, interval.low, interval.high};
}

}  // namespace grainfield::coupling
