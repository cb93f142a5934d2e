// A layer of disks, pentagons or spheres under a point load, with Roul's table 5.1 as defaults. SI,
// 2D: areal density in kg/m2, stiffness and Young's modulus in N/m.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "dem/grains/packing.h"
#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"
#include "dem/run/setup.h"

namespace grainfield::dem {

struct LoadSetup {
  /// How the layer comes to rest before: damped: slow damped dynamics | newton: these until its
  /// energy is at rest, then the quasi-static solver.
  std::string rest = "damped";
  double force = 300;             ///< N, downwards on one grain
  std::string method = "damped";  ///< damped: slow damped dynamics | newton: quasi-static solver
  double unbalanced_force_ratio = 1e-8;  ///< newton: to be reached
  double ramp_time = 0.5;         ///< s from 0 to the full force (smooth ramp); damped, force
  std::string control = "force";  ///< damped: force (the ramp) | speed (2D: a piston, piston.h)
  double speed = 0.01;            ///< m/s of the piston; speed
  double position = 0.5;          ///< of the width: the top grain nearest to it carries the force
  double weights = 0.1;           ///< 3D: force over a grain's mean weight; 0: load.force
  double position_y = 0.5;        ///< 3D: likewise along y
  double radius = 0;        ///< m; 3D: grains of the surface so near to that one share the force
  double probe_strain = 0;  ///< 3D: of each probe before the load (layer_probe.h); 0: none

  auto members() const {
    return std::tie(rest, force, method, unbalanced_force_ratio, ramp_time, position, weights,
                    position_y, radius, probe_strain, control, speed);
  }
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

/// Throws std::invalid_argument naming the key of the setup that does not hold
/// ("motion.time_step"). The bits of the result do not depend on threads.
std::unique_ptr<Run> make_point_load_run(const PointLoadSetup& setup, std::uint64_t seed,
                                         int threads);

/// Throws std::invalid_argument naming the key, as make_point_load_run would for any of these
/// seeds, and for more than kMostGrains. Where grains are drawn beforehand at most `draws` of them
/// are; if more would be, limits that depend on them are taken a little tighter.
Outlook foresee_point_load(const PointLoadSetup& setup, const std::vector<std::uint64_t>& seeds,
                           std::int64_t draws);

}  // namespace grainfield::dem
