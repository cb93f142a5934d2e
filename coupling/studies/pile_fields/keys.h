// The section of averaged fields.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_fields_keys(SectionKeys s);

inline constexpr KeySection kFieldsKeys{"fields", KeyRole::analysis, declare_fields_keys};

}  // namespace grainfield::coupling
