#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

/// Study "point-load-verdict": stress models fitted to layers under a point load, and ranked.
Study point_load_verdict_study();

}  // namespace grainfield::coupling
