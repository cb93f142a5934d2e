// What is averaged over piles and how: [fields] of a case.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// What is averaged over piles and how.
struct FieldsSetup {
  std::vector<std::string> topics = {"rve_size", "strain_measures", "elastic", "fabric", "forces"};
  double rve_diameters = 6;  ///< radius of the RVE, mean diameters
  std::vector<double> sizes = {1, 1.5, 2, 2.5, 3,  4,
                               5, 6,   7, 8,   10, 12};  ///< of rve_size, likewise
  double tolerance = 0.1;                                ///< of rve_size
  std::string measure = "cambou";                        ///< strain of elastic, fabric and forces
  std::int64_t columns = 61, rows = 25;                  ///< of the maps
  std::vector<double> heights = {0.15, 0.3, 0.5};
  std::int64_t resamples = 1000;
};

}  // namespace grainfield::coupling
