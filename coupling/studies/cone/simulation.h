// Cones of spheres or superellipsoids: how they are poured. Up is z, the floor's surface is z = 0,
// the source's axis is x = y = 0.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"
#include "dem/run/setup.h"
#include "dem/sleep/sleep_settings.h"

namespace grainfield::dem {

/// The case keys [cone].
struct ConePlan {
  // -- the grains
  std::string shape = "sphere";           ///< sphere | superellipsoid
  int grains = 5000;                      ///< poured; what leaves the floor is taken away
  double radius = 0.002;                  ///< m; of superellipsoids the unit of their semi-axes
  double polydispersity = 0.1;            ///< sphere: radii in radius (1 -+ this)
  double axis_min = 0.8, axis_max = 1.2;  ///< superellipsoid: semi-axes over the radius
  double exponent_min = 0.7, exponent_max = 1.3;  ///< superellipsoid

  // -- where they come from
  std::string source = "point";  ///< point: a mouth above the apex | rain: over the whole floor |
                                 ///< cylinder: filled, then lifted
  double mouth = 0.01;           ///< m; radius of the mouth, and of the cylinder
  double rate = 2000;            ///< grains/s, or as many as there is room for
  double drop = 0.02;            ///< m from the heap's top to the grains that start
  double speed = 0.5;            ///< m/s downwards, at the start
  double lift_speed = 0.05;      ///< m/s; cylinder

  // -- and fall on
  std::string floor = "rough";  ///< rough: fixed spheres | smooth: flat
  double floor_radius = 0.1;    ///< m; a grain beyond has left the floor

  auto members() const {
    return std::tie(shape, grains, radius, polydispersity, axis_min, axis_max, exponent_min,
                    exponent_max, source, mouth, rate, drop, speed, lift_speed, floor,
                    floor_radius);
  }
};

/// pour -> (lift) -> settle -> rest with every grain awake -> snapshot "pile".
struct ConeSetup {
  ConePlan plan;
  MaterialSetup material = [] {
    MaterialSetup m;
    m.law = "hertz";
    m.density = 2500;
    m.young = 2e6;
    m.damping = 0.3;
    return m;
  }();
  MotionSetup motion;
  RestSetup rest = [] {
    RestSetup r;
    r.unbalanced_force_ratio = 1e-4;
    r.kinetic_to_elastic_energy = 1e-6;
    r.background_damping = 20;
    return r;
  }();
  SleepSettings sleep{.on = true};

  auto members() const { return std::tie(plan, material, motion, rest, sleep); }
};

/// As foresee_pile (outlook.h), of make_cone_run.
Outlook foresee_cone(const ConeSetup& setup, const std::vector<std::uint64_t>& seeds,
                     std::int64_t draws);

/// A cone at rest: snapshot "pile", its fixed grains first. Throws std::invalid_argument naming the
/// key of the setup that does not hold ("cone.mouth").
std::unique_ptr<Run> make_cone_run(const ConeSetup& setup, std::uint64_t seed, int threads);

}  // namespace grainfield::dem
