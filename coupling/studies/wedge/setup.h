// The heap of the study wedge: [wedge] of a case.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// Heap of the study wedge.
struct WedgeSetup {
  double phi_deg = 28, left_deg = 28, right_deg = 28;  ///< friction angle, slopes
  double rho_g = 1;                                    ///< N/m^3 (2D: N/m^2)
  double height = 1;                                   ///< m
  std::vector<double> depths = {0.5, 0.75, 1};         ///< of the height; the base is always seen
  std::int64_t points = 121;
  std::vector<std::string> histories;  ///< all combinations of what is listed
  std::vector<double> dilations_deg;
  std::vector<std::string> bases;  ///< rough, smooth, or the friction angle of a frictional one
};

}  // namespace grainfield::coupling
