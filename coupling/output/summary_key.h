// The declaration of a figure in summary.json, beside what computes it.
#pragma once
#include <string>

namespace grainfield::coupling {

struct SummaryKey {
  std::string pattern;  ///< '*' stands for one name without dots of its own meaning
  std::string unit;     ///< "-" for pure numbers, "text" for words
  std::string meaning;
};

}  // namespace grainfield::coupling
