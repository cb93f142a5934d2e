// Models of heaps with two different slopes (continuum/closed/cantelaube_asymmetric.h).
#pragma once
#include <vector>

#include "coupling/fit/heap_models.h"

namespace grainfield::coupling {

/// Friction angle: facts.friction(), at least the steeper slope.
///   cantelaube_asymmetric_zero      flanks at yield, one linear core by continuity; no parameter
///   cantelaube_asymmetric_minus, _plus   the core yields on a ray, whose angle is free: dip, peak;
///                                   absent where the theory has no such core
///   cantelaube_asymmetric_friction  as _zero, the friction angle free
///   cantelaube_asymmetric_flanks    one linear core, flanks of free coefficients k_left, k_right
///   cantelaube_asymmetric           the same with a kink of free size on a free ray in the core
std::vector<RegistryEntry> two_sided_entries(const HeapFacts& facts);

}  // namespace grainfield::coupling
