// The material of a case's grains: what its keys follow, and what of it is said to people.
#pragma once
#include <optional>
#include <string>

#include "coupling/case/apply.h"
#include "dem/laws/restitution.h"

namespace grainfield::coupling {

/// Fills in the keys of [material] that follow from others (dem/laws/material_defaults.h) where
/// nobody wrote them. Throws std::invalid_argument beginning with the key that contradicts another.
void follow_material(Case& value);

/// The grain of the study's nominal size; nothing for a study without [material].
std::optional<dem::RoundGrain> nominal_grain(const Case& value);

/// "k_t/k_n = 0.286, restitution 0.9 of two disks of radius 4.5 mm at 0.42 m/s"; empty for a study
/// without [material].
std::string material_text(const Case& value);

}  // namespace grainfield::coupling
