// How a sample's periodic cell flows.
#pragma once
#include "coupling/studies/sample/simulation/path.h"
#include "dem/run/cell_servo.h"

namespace grainfield::dem {

/// Its velocity gradient in a phase, 1/s: what is prescribed, and what the servo answers to the
/// pressures that it holds. `fraction`: the solid fraction now.
Eigen::Matrix3d cell_flow(const SamplePlan& plan, SamplePhase phase, const Vec3& pressure,
                          double fraction, CellServo& servo);

}  // namespace grainfield::dem
