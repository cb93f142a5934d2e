// Whether grains are stiff enough to lie on each other at all.
#pragma once
#include "dem/laws/material_setup.h"

namespace grainfield::dem {

/// What the grains of a study bear.
struct Burden {
  double radius = 0;  ///< of a mean grain, m
  double height = 0;  ///< of what lies on the lowest ones, m
  double speed = 0;   ///< at which they meet it, m/s
};

/// Throws std::invalid_argument naming material.young, or material.normal_stiffness, where a grain
/// would sink into a flat floor by half its radius at that speed or under that column of grains:
/// softer ones pass through each other and through the floor. Of laws without either: nothing. 3D.
void check_stiff_enough(const MaterialSetup& material, const Burden& burden);

}  // namespace grainfield::dem
