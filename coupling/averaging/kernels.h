// The kernels there are, one file each.
#pragma once
#include <memory>

#include "coupling/averaging/kernel.h"

namespace grainfield::coupling {

std::unique_ptr<Kernel> make_lucy(double width, int dim);
std::unique_ptr<Kernel> make_gaussian(double width, int dim);
std::unique_ptr<Kernel> make_heaviside(double width, int dim);

}  // namespace grainfield::coupling
