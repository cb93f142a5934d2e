// The section of the studies of solvers.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_elastic_keys(SectionKeys s);

inline constexpr KeySection kElasticKeys{"elastic", KeyRole::analysis, declare_elastic_keys};

}  // namespace grainfield::coupling
