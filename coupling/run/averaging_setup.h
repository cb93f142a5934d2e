// From [average] of a case to the options of averaging.
#pragma once
#include <memory>
#include <string>

#include "coupling/averaging/average.h"
#include "coupling/averaging/kernel.h"
#include "coupling/case/case.h"

namespace grainfield::coupling {

/// Options of one of setup.methods for grains of this mean diameter, m.
AverageOptions average_options(const AverageSetup& setup, const std::string& method,
                               double diameter, int threads);
/// The kernel through which models are seen and base forces are smeared. A circle is the Heaviside
/// kernel; a square is taken as the disk of equal area.
std::unique_ptr<Kernel> seeing_kernel(const AverageOptions& options);
/// "coarse graining, lucy kernel, w = 0.0055 m": for captions.
std::string describe(const AverageOptions& options);

}  // namespace grainfield::coupling
