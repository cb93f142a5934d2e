// What soft disks cannot be moved with or from.
#pragma once
#include <vector>

#include "dem/implicit/soft_disks.h"

namespace grainfield::dem {

/// Throws std::invalid_argument as the constructor of SoftDisks says.
void check_soft(const SoftScene& scene, const std::vector<Body<2>>& disks,
                const ImplicitSettings& settings);

}  // namespace grainfield::dem
