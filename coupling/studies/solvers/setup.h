// Points and load of the studies of solvers: [problem] of a case.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// The layer or heap, its load, and where it is looked at.
struct ProblemSetup {
  double force = 1;      ///< N (2D: N per metre of depth into the page)
  double height = 0.15;  ///< m; elastic-layer
  std::int64_t dim = 2;
  std::string base = "smooth";                     ///< elastic-layer
  std::vector<double> depths = {0.05, 0.1, 0.15};  ///< m
  double half_width = 0.3;                         ///< m
  std::int64_t points = 61;
  double r = 1, t = 1;  ///< orthotropic-layer: anisotropy
};

}  // namespace grainfield::coupling
