// Numbers counted in equal bins.
#pragma once
#include <Eigen/Core>

namespace grainfield::coupling {

struct DensityHistogram {
  Eigen::VectorXd edges;   ///< bins + 1, ascending, unit of the numbers
  Eigen::VectorXi counts;  ///< per bin; a number on an edge belongs above it, on the last one below
  Eigen::VectorXd density;  ///< counts / (all numbers * width): its integral is the share inside
  Eigen::VectorXd error;    ///< sqrt(counts) / (all numbers * width), if they are independent
  int outside = 0;          ///< numbers below or above
  Eigen::VectorXd centres() const;
};

/// nan are left out and not counted. Throws std::invalid_argument for fewer than one bin or high
/// not above low.
DensityHistogram density_histogram(const Eigen::VectorXd& numbers, double low, double high,
                                   int bins);

}  // namespace grainfield::coupling
