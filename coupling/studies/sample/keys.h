// The section of samples, and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_sample_keys(SectionKeys s);

inline constexpr KeySection kSampleKeys{"sample", KeyRole::grains, declare_sample_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> sample_figures();

}  // namespace grainfield::coupling
