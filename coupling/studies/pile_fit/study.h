#pragma once
#include "coupling/case/study.h"

namespace grainfield::coupling {

/// Study "pile-fit": stress models fitted to poured or finished piles, and ranked.
Study pile_fit_study();

}  // namespace grainfield::coupling
