// The door to the finite-element library for the files that declare its models.
#pragma once
#include <memory>

#include "continuum/model.h"

namespace grainfield::continuum {

/// The named model of the finite-element library (continuum/fe/plugin.h) with complete settings;
/// loads the library on first use. Throws BadParameter, and ComputationFailed when the library is
/// missing.
std::unique_ptr<Model> make_in_fe_library(const char* name, const Settings& settings);

}  // namespace grainfield::continuum
