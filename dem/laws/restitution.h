// What is left of the speed of two equal round grains that collide head on, and the dashpot that
// leaves a wanted share of it.
//
// A law with the elastic force K d^n and a dashpot c d^((n-1)/2) v keeps the same restitution at
// every speed: with x = d^((n+1)/2) it is a damped spring of frequency w0 = sqrt((n+1)/2 K/m) and
// the damping share c/(2 m w0). A contact ends where its force vanishes, as no law here attracts
// (Schwager and Poeschel 2007).
#pragma once
#include "dem/laws/material_setup.h"

namespace grainfield::dem {

/// Time over 1/w0 until the force of a spring with a dashpot of this share of the critical one
/// vanishes, -.
double time_of_dashpot(double share);
/// Restitution of a linear spring with a dashpot of this share of the critical one, -.
double restitution_of_dashpot(double share);
/// Its inverse: the share for a restitution in (0, 1].
double dashpot_of_restitution(double restitution);

/// A pair's grain: with material.density it is a disk (dim 2) or a sphere (dim 3).
struct RoundGrain {
  int dim = 2;
  double radius = 0;  ///< m
};
/// Its mass, kg.
double mass_of(const RoundGrain& grain, double density);

/// Restitution of two such grains that meet head on at `speed`, m/s: their motion is integrated
/// under the material's law. 0 where they do not part. Throws std::invalid_argument naming
/// material.law for a law that does not hold in that dimension.
double head_on_restitution(const MaterialSetup& material, const RoundGrain& grain, double speed);

/// Tangential over normal stiffness, -: k_t/k_n, k_t/E, or Mindlin's 2 (1 - nu)/(2 - nu).
double stiffness_ratio(const MaterialSetup& material);

}  // namespace grainfield::dem
