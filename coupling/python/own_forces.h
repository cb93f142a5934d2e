// Forces of an engine that functions of Python give.
#pragma once
#include <memory>
#include <string>

#include "coupling/python/bindings.h"
#include "dem/engine/added_forces.h"

namespace grainfield::python {

/// A force that calls function(grains, contacts) with dictionaries of arrays, which are read-only
/// views (contacts: None, unless it acts in contacts), and expects the pair (forces, torques or
/// None). What the function raises goes through the step.
std::shared_ptr<dem::AddedForce> own_force(const py::function& function, const std::string& name,
                                           long every, bool in_contacts);

}  // namespace grainfield::python
