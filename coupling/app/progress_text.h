// The line that long work shows.
#pragma once
#include <string>

#include "coupling/run/ensemble.h"

namespace grainfield::coupling {

/// "1:02:03", "4:05"; "?" below 0.
std::string duration_text(double seconds);
/// " 12 %  1/4 done  pour 80/6500  t 1.234 s  80 grains, 5 awake  kinetic 1.0e-03 J  unbalanced
/// 1.0e-02  4:05 left", in one line.
std::string progress_text(const EnsembleProgress& progress);

}  // namespace grainfield::coupling
