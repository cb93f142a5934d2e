// Dips and peaks of the base pressure over all recorded pours, judged together.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "coupling/reproduce/results.h"

namespace grainfield::coupling {

/// One pour with an ensemble.
struct RecordedDip {
  std::string study;
  Measured difference;  ///< shoulder - centre, rho g h of each pile
  double p_value = 0;   ///< two-sided, Student's t over the realizations; nan with too few
  double p_holm = 0;    ///< corrected for all pours in the record (statistics/holm.h)
  std::string word;     ///< dip, peak, neither; undecided: too few realizations
};

/// Every study of the record that has a dip's difference, in the order of their names. A dip or a
/// peak is one at 5 % after the correction.
std::vector<RecordedDip> recorded_dips(const Results& results);
/// That of one study; nothing where it has none.
std::optional<RecordedDip> recorded_dip(const Results& results, const std::string& study);

}  // namespace grainfield::coupling
