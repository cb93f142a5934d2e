// Soft disks for tests: in boxes, on the ground, in lattice piles.
#pragma once
#include <cmath>
#include <numbers>
#include <vector>

#include "dem/grains/lattice_pile.h"
#include "dem/implicit/soft_disks.h"

namespace grainfield::dem::testing {

inline Body<2> soft_disk(double x, double y, double radius = 0.5, double mass = 1) {
  Body<2> out;
  out.position = {x, y};
  out.radius = radius;
  out.inverse_mass = 1 / mass;
  out.inverse_inertia = 2 / (mass * radius * radius);
  return out;
}

/// Half the period of a contact of two of them over ten: what explicit integrators take.
inline double explicit_step(double mass, double stiffness) {
  return 0.1 * std::numbers::pi * std::sqrt(mass / stiffness);
}

inline ImplicitSettings steps_of(double time_step,
                                 ImplicitScheme scheme = ImplicitScheme::conserving) {
  ImplicitSettings out;
  out.scheme = scheme;
  out.time_step = time_step;
  return out;
}

inline SoftWall ground(const SoftLaw& law) { return {{0, 0}, {0, 1}, law}; }

/// Smooth elastic disks on smooth elastic ground under gravity 1.
inline SoftScene smooth_ground(double stiffness) {
  SoftScene out;
  out.grains.stiffness = stiffness;
  out.walls = {ground(out.grains)};
  out.gravity = {0, -1};
  return out;
}

/// The lattice's disks; those of the lowest row do not spin.
inline std::vector<Body<2>> pile_bodies(const LatticeSetup& lattice, double density) {
  std::vector<Body<2>> out;
  const double r = lattice.radius, mass = density * std::numbers::pi * r * r;
  for (const NewGrain& g : lattice_pile_grains(lattice, density)) {
    out.push_back(soft_disk(g.x, g.y, r, mass));
    if (!g.rotates) out.back().inverse_inertia = 0;
  }
  return out;
}

}  // namespace grainfield::dem::testing
