// Misprints and inconsistencies of the sources, re-derived from the field equations.
#pragma once
#include <string>
#include <vector>

namespace grainfield::coupling {

struct Misprint {
  std::string where, printed, holds;
};

/// In the order of the page.
const std::vector<Misprint>& misprints();

}  // namespace grainfield::coupling
