// A sample as it is at a moment of its run, read from the engine.
#pragma once
#include "coupling/studies/sample/simulation/setup.h"
#include "dem/engine/engine.h"

namespace grainfield::dem {

/// Edge along each axis, m; without looking at a contact in a cell.
Vec3 sample_edges(const SamplePlan& plan, const Engine& engine);
/// Along each axis, what servos hold: the pressure in a cell, that on the walls that move. Pa
/// (N/m), compression positive.
Vec3 held_pressure(const SamplePlan& plan, const Engine& engine);
/// Solid fraction of grains of this volume (area), m3 (m2).
double solid_fraction(const SamplePlan& plan, const Engine& engine, double solid_volume);

}  // namespace grainfield::dem
