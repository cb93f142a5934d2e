// Models that are added while the program runs, such as a function of Python, beside the
// registry's.
#pragma once
#include <functional>
#include <memory>

#include "continuum/model.h"

namespace grainfield::continuum {

/// Models that may be added.
inline constexpr std::size_t kMostOwnModels = 64;

using MakeModel = std::function<std::unique_ptr<Model>(const Settings&)>;

/// Adds a model to registry(), or puts it in the place of the one that was added under its name;
/// sets info.make, which calls `make`. Not while models are made or evaluated: find_model() returns
/// references. Throws BadParameter for the name of a model that was not added here, for one of
/// other characters than letters, digits and _, and where kMostOwnModels are there.
void add_own_model(ModelInfo info, MakeModel make);

}  // namespace grainfield::continuum
