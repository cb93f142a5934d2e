// The servo of a sample's cell: how stiff its grains' contacts are under the pressure.
#pragma once
#include "coupling/studies/sample/simulation/setup.h"
#include "dem/engine/engine.h"
#include "dem/run/cell_servo.h"

namespace grainfield::dem {

/// With everything but the time between two measurements. Stiffness and dashpot of the contact are
/// those of two mean grains, of polygons edge on edge, that push each other with the mean force of
/// a packing under plan.pressure.
CellServo cell_servo_for(const SampleSetup& setup, const EngineSettings& settings);

}  // namespace grainfield::dem
