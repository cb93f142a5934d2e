// How large a model's equations may be, told from its settings before anything is allocated.
#pragma once
#include <string>

#include "continuum/model.h"

namespace grainfield::continuum {

/// Most unknowns of a finite-element model, unless its parameter most_unknowns says otherwise: one
/// to two gigabytes of matrices.
inline constexpr double kMostUnknowns = 2e6;

Parameter most_unknowns();

/// Throws BadParameter naming the parameters of the mesh that a finite-element model would begin
/// with (ModelInfo::first_mesh), settings as complete() returns them, where its unknowns take more
/// than a machine of 4 GB has. Other models pass.
void require_possible(const ModelInfo& info, const Settings& complete);

/// Throws ComputationFailed "NAME: ..." when a mesh that is about to be refined would have more
/// than `most` unknowns (its parameter most_unknowns); `by` is the parameter that asks for it.
void require_unknowns(const std::string& name, double unknowns, double most, const char* by);

}  // namespace grainfield::continuum
