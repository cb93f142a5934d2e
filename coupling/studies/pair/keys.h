// The section of two bodies that meet.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_pair_keys(SectionKeys s);

inline constexpr KeySection kPairKeys{"pair", KeyRole::grains, declare_pair_keys};

}  // namespace grainfield::coupling
