// How the walls of a sample's box move.
#pragma once
#include <array>
#include <memory>

#include "coupling/studies/sample/simulation/path.h"
#include "dem/engine/engine.h"

namespace grainfield::dem {

/// The wall that moves along an axis.
const char* moved_wall(int axis, int dim);

/// The walls' motion at the beginning of a phase. `box`: the edges when the grains were placed, by
/// which servos are limited; `first`: those of the first state, by which strains are counted, where
/// it is there. All m. Sides that tilt are left to tilt_sides.
void lead_walls(Engine& engine, const SamplePlan& plan, SamplePhase phase,
                const std::array<double, 3>& box, const Vec3& first);

/// Turns left and right about their feet, so that they have the tilt of the shear `then` after so
/// many steps.
void tilt_sides(Engine& engine, const SamplePlan& plan, double then, long steps);

}  // namespace grainfield::dem
