// Pictures of what fits know of their parameters.
#pragma once
#include <vector>

#include "coupling/fit/fit.h"
#include "coupling/report/report.h"

namespace grainfield::coupling {

/// One frame per fitted parameter that has an error: its density by the covariance (Student's t of
/// realizations - 1 degrees of freedom about the best value, as the intervals) and a normal one of
/// the bootstrap's standard deviation. At most `most` frames, fits in their order; no section
/// without any.
std::vector<Section> posterior_sections(const std::vector<const Fit*>& fits, int realizations,
                                        int most = 12);

}  // namespace grainfield::coupling
