// The engine for one shape, compiled in a file of its own (disks.cc, polygons.cc, ...).
#pragma once
#include <memory>

#include "dem/engine/engine.h"

namespace grainfield::dem {

/// With the law and the integrator of the settings. Throws std::invalid_argument naming the key
/// when they do not go with the shape.
template <class Store>
std::unique_ptr<Engine> engine_of(const EngineSettings& settings);

}  // namespace grainfield::dem
