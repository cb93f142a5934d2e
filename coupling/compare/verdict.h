// The evidence that profiles are, for the judge (judge/judge.h).
#pragma once
#include "coupling/compare/compare.h"

namespace grainfield::coupling {

/// Fills chi2_per_dof, chance and dof of comparison.results, per profile and overall, and
/// comparison.judgement. Needs profiles, models and the rest of the results.
void judge_comparison(Comparison& comparison);

}  // namespace grainfield::coupling
