// Plain settings of a discrete-element study, with Roul's table 5.1 as defaults. SI, 2D:
// areal density in kg/m2, stiffness and Young's modulus in N/m.
#pragma once
#include <string>
#include <tuple>
#include <vector>

#include "dem/heap/source.h"
#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/packing/lattice_pile.h"
#include "dem/packing/packing.h"

namespace grainfield::dem {

struct RestSetup {
  /// Mean resultant / mean contact force, and mean |moment| / radius likewise, are below this.
  double unbalanced_force_ratio = 1e-6;
  double kinetic_to_elastic_energy = 1e-10;
  double background_damping = 100;  ///< 1/s, acceleration -= this * v while coming to rest
  double max_time = 20;             ///< s of simulated time for any one rest

  auto members() const {
    return std::tie(unbalanced_force_ratio, kinetic_to_elastic_energy, background_damping,
                    max_time);
  }
};

struct LoadSetup {
  double force = 300;             ///< N, downwards on one grain
  std::string method = "damped";  ///< damped: slow damped dynamics | newton: quasi-static solver
  double unbalanced_force_ratio = 1e-8;  ///< newton: to be reached
  double ramp_time = 0.5;                ///< s from 0 to the full force (smooth ramp); damped
  double position = 0.5;    ///< of the width: the top grain nearest to it carries the force
  double weights = 0.1;     ///< 3D: force over a grain's mean weight; 0: load.force
  double position_y = 0.5;  ///< 3D: likewise along y
  double radius = 0;        ///< m; 3D: grains of the surface so near to that one share the force
  double probe_strain = 0;  ///< 3D: of each probe before the load (layer_probe.h); 0: none

  auto members() const {
    return std::tie(force, method, unbalanced_force_ratio, ramp_time, position, weights, position_y,
                    radius, probe_strain);
  }
};

/// The ground, y = 0, with side walls at its ends that only catch stray grains: a pile that leans
/// on them is refused.
struct FloorSetup {
  std::string kind = "smooth";  ///< smooth: flat, with material.floor_friction | rough: fixed
                                ///< grains like those of the pile, side by side below y = 0
  double length = 1.6;          ///< m

  auto members() const { return std::tie(kind, length); }
};

/// Grains at rest sleep while the pile is poured (engine.h: SleepSettings).
struct SleepSetup {
  bool on = true;
  double quiet_time = 5e-3;   ///< s
  double quiet_move = 8e-4;   ///< diameters within quiet_time
  double quiet_creep = 0.02;  ///< diameters/s
  double quiet_force = 0.01;  ///< out of balance over the grain's load
  double wake_force = 0.015;  ///< likewise, ...
  double wake_time = 0.02;    ///< s: ... in the mean of so long, ...
  double wake_shock = 0.5;    ///< ... or at once
  double wake_speed = 0.5;    ///< sqrt(g d)
  double wake_reach = 2;      ///< d v / sqrt(g d), of a grain that comes at the speed v

  auto members() const {
    return std::tie(on, quiet_time, quiet_move, quiet_creep, quiet_force, wake_force, wake_time,
                    wake_shock, wake_speed, wake_reach);
  }
};

/// After the rest: gravity is changed, slowly, and the pile comes to rest again. Every change
/// starts from the pile at material.gravity.
struct ChangeSetup {
  std::vector<double> gravity;    ///< m/s2, above 0, one snapshot for each; empty: none
  std::string method = "newton";  ///< newton: quasi-static solver | damped: slow damped dynamics
  double unbalanced_force_ratio = 1e-8;  ///< newton: to be reached
  double ramp_time = 0.5;  ///< s from the old to the new gravity (smooth ramp); damped

  auto members() const { return std::tie(gravity, method, unbalanced_force_ratio, ramp_time); }
};

/// A pile (Roul ch. 3): pour -> settle -> rest with every grain awake -> snapshot "pile" -> for
/// each changed gravity a snapshot "gravity_G", G as {:g} prints it ("gravity_8.829").
struct PileSetup {
  ShapeSetup shape;
  SourceSetup source;
  FloorSetup floor;
  MaterialSetup material = [] {
    MaterialSetup m;
    m.friction = m.floor_friction = 0.54;
    return m;
  }();
  MotionSetup motion;
  RestSetup rest;
  SleepSetup sleep;
  ChangeSetup change;

  auto members() const {
    return std::tie(shape, source, floor, material, motion, rest, sleep, change);
  }
};

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

struct PointLoadSetup {
  PackingSetup packing;
  MaterialSetup material;
  MotionSetup motion;
  RestSetup rest;
  LoadSetup load;

  auto members() const { return std::tie(packing, material, motion, rest, load); }
};

/// The force that the layer is loaded with, N: load.force; in 3D load.weights times the mean weight
/// of a grain where that is given.
double force_of_load(const PointLoadSetup& setup);

}  // namespace grainfield::dem
