// What of a finished run goes into the folder that the page of reproductions is made from.
#pragma once
#include <string>
#include <vector>

namespace grainfield::coupling {

/// Copies into `results`, under the name of the run's case: summary.json (CASE.json), profiles.md
/// (CASE.profiles.md) and, of a pile, the report's pictures of the base pressure and of the volume
/// fraction (CASE.base-pressure.svg, CASE.volume-fraction.png). Gives the files written. Throws
/// std::invalid_argument when the run's folder holds no summary.json with a case.name.
std::vector<std::string> record_run(const std::string& run, const std::string& results);

}  // namespace grainfield::coupling
