// The section of lattice piles.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_lattice_keys(SectionKeys s);

inline constexpr KeySection kLatticeKeys{"lattice", KeyRole::grains, declare_lattice_keys};

}  // namespace grainfield::coupling
