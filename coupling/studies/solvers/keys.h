// The section of the studies of solvers: the boundary-value problem.
#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_problem_keys(SectionKeys s);

inline constexpr KeySection kProblemKeys{"problem", KeyRole::analysis, declare_problem_keys,
                                         "elastic"};

}  // namespace grainfield::coupling
