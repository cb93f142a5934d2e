// Keys that do not hold in the dimensions of the case, and values that are allowed and hardly
// meant: grains of metres, falls of thousands of diameters.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/apply.h"

namespace grainfield::coupling {

/// A doubt about one key that was written.
struct Doubt {
  std::string key, text;  ///< text: "FILE:LINE: KEY: ...", for a warning
};
/// The size of grains, their density, and the way they fall. Of a finished draft, or of one whose
/// grains are refused.
std::vector<Doubt> doubts(const Draft& draft);

/// Throws std::invalid_argument "ORIGIN: KEY: found ..., allowed: ..." for a key or a word, written
/// or standing by default, that does not hold in the dimensions of the case's grains.
void check_dimensions(const Draft& draft);

}  // namespace grainfield::coupling
