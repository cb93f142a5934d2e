// The section of samples.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_sample_keys(SectionKeys s);

inline constexpr KeySection kSampleKeys{"sample", KeyRole::grains, declare_sample_keys};

}  // namespace grainfield::coupling
