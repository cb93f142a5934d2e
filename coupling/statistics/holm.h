// Holm's correction for many comparisons.
#pragma once
#include <vector>

namespace grainfield::coupling {

/// The p values corrected for all of them (Holm's step-down, Scand. J. Statist. 6 (1979) 65), in
/// the order given: the k-th smallest of m, k from 0, is multiplied by m - k, none is below a
/// smaller one's, none above 1. nan stays nan and is not counted.
std::vector<double> holm(const std::vector<double>& p_values);

}  // namespace grainfield::coupling
