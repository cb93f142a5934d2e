// From [average] of a case to the options of averaging.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/kernel.h"
#include "coupling/case/study.h"

namespace grainfield::coupling {

struct AverageSetup {
  std::vector<std::string> methods = {"coarse_graining", "particle_centre"};
  std::string kernel = "lucy";
  double width = 0;  ///< m; 0 = width_diameters mean diameters
  double width_diameters = 1;
  std::string rve_shape = "circle";
  double rve_radius = 0;  ///< m; 0 = rve_diameters mean diameters
  double rve_diameters = 2.5;
  std::vector<double> depths = {0.25, 0.5, 0.75};  ///< of the layer height
  std::int64_t points = 121;                       ///< per profile
  double half_width = 0;  ///< m either side of the load; 0 = the whole layer
  std::int64_t map_columns = 81;
  std::int64_t map_rows = 31;
};

/// Its keys.
void declare_average_keys(SectionKeys s);
inline constexpr KeySection kAverageKeys{"average", KeyRole::analysis, declare_average_keys};

/// What an analysis holds of profiles, so many for each method, and of the map.
std::vector<AveragedValues> averaged_values(const AverageSetup& setup, std::size_t profiles);

/// Options of one of setup.methods for grains of this mean diameter, m.
AverageOptions average_options(const AverageSetup& setup, const std::string& method,
                               double diameter, int threads);
/// The kernel through which models are seen and base forces are smeared. A circle is the Heaviside
/// kernel; a square is taken as the disk of equal area (in space the cube as that ball).
std::unique_ptr<Kernel> seeing_kernel(const AverageOptions& options, int dim = 2);
/// "coarse graining, lucy kernel, w = 0.0055 m": for captions.
std::string describe(const AverageOptions& options);

}  // namespace grainfield::coupling
