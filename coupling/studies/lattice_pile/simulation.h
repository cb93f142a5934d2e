// A lattice pile of disks at rest (Liffman).
#pragma once
#include <cstdint>
#include <memory>
#include <tuple>

#include "dem/grains/lattice_pile.h"
#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"
#include "dem/run/setup.h"

namespace grainfield::dem {

/// The lattice pile comes to rest under its weight: rest -> snapshot "pile". Disks of the lowest
/// row do not spin, as Liffman's static friction acts on their centres (eq. 30, 33).
struct LatticePileSetup {
  LatticeSetup lattice;
  MaterialSetup material = [] {
    MaterialSetup m;
    m.law = "linear";
    m.normal_stiffness = 3.5e8;  // m g/(K d) = 1e-6 with these disks: close to Liffman's hard ones
    m.tangential_stiffness = 1e8;
    m.friction = 0;        // at rest Liffman's grains exert no tangential force on each other
    m.floor_friction = 1;  // above tan 30 degrees, the steepest H/N
    return m;
  }();
  MotionSetup motion;
  RestSetup rest = [] {
    RestSetup r;
    r.unbalanced_force_ratio = 1e-8;
    r.background_damping = 1000;  // about critical for the slowest swing of 45 layers
    return r;
  }();

  auto members() const { return std::tie(lattice, material, motion, rest); }
};

/// A lattice pile at rest. Its snapshot "pile" has the lowest row first, from left to right.
/// The seed is only noted: the lattice is perfect.
std::unique_ptr<Run> make_lattice_pile_run(const LatticePileSetup& setup, std::uint64_t seed,
                                           int threads);

/// Throws std::invalid_argument naming the key, as make_lattice_pile_run would.
Outlook foresee_lattice_pile(const LatticePileSetup& setup);

}  // namespace grainfield::dem
