// What messages say of integrators that leap (integrator.h).
#pragma once
#include <string>
#include <vector>

#include "dem/motion/registry.h"

namespace grainfield::dem {

/// Their words.
inline std::vector<std::string> integrators_that_leap() {
  return words_where<AnyIntegrator>([]<class Kind>() { return Kind::leaps; });
}

}  // namespace grainfield::dem
