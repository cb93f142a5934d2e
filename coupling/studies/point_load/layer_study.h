// Parts that the studies of loaded layers share.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

/// Its sections are those of grains, load and averages; and it says what models are told of them.
Study layer_study();

}  // namespace grainfield::coupling
