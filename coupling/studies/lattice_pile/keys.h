// The section of lattice piles, and their figures.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_lattice_keys(SectionKeys s);

inline constexpr KeySection kLatticeKeys{"lattice", KeyRole::grains, declare_lattice_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> lattice_pile_figures();

}  // namespace grainfield::coupling
