// The study "pair": two bodies that collide, or one led against the other, to see what a contact
// law does with its parameters.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

Study pair_study();

}  // namespace grainfield::coupling
