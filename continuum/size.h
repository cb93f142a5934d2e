// How large a model's equations may be, told from its settings before anything is allocated.
#pragma once
#include "continuum/model.h"

namespace grainfield::continuum {

/// Throws BadParameter naming the parameters of the mesh that a finite-element model would begin
/// with, settings as complete() returns them, where its unknowns take more than a machine of 4 GB
/// has. Other models pass.
void require_possible(const ModelInfo& info, const Settings& complete);

}  // namespace grainfield::continuum
