// The section of averaged fields, and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_fields_keys(SectionKeys s);

inline constexpr KeySection kFieldsKeys{"fields", KeyRole::analysis, declare_fields_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> pile_fields_figures();

}  // namespace grainfield::coupling
