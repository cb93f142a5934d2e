// Values that are allowed and hardly meant: grains of metres, falls of thousands of diameters.
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

}  // namespace grainfield::coupling
