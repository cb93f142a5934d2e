// The closed-form models as the registry lists them.
#pragma once
#include "continuum/model.h"

namespace grainfield::continuum {

ModelInfo flamant_info();
ModelInfo boussinesq_info();
ModelInfo layer_info();
ModelInfo hydrostatic_info();
ModelInfo liffman_info();

}  // namespace grainfield::continuum
