// Settings of a sample of grains under compression and shear. SI; in 2D areal density in kg/m2,
// stiffness and stress in N/m.
#pragma once
#include <string>
#include <tuple>

#include "dem/laws/material_setup.h"
#include "dem/motion/motion_setup.h"
#include "dem/run/setup.h"

namespace grainfield::dem {

/// The case keys [sample].
struct SamplePlan {
  // -- grains
  int dim = 2;
  std::string shape = "disk";  ///< disk | rand1 | regular (2D), sphere | superellipsoid (3D)
  int grains = 500;
  std::string sizes = "uniform";          ///< mono | bidisperse | uniform
  double radius = 0.0045;                 ///< m; the larger one of bidisperse sizes
  double polydispersity = 0.2;            ///< uniform: radii in radius (1 -+ this)
  double size_ratio = 1.4;                ///< bidisperse: larger over smaller radius
  double fraction_small = 0.5;            ///< bidisperse: share of the smaller ones, by number
  int corners_min = 6, corners_max = 8;   ///< rand1, regular
  double axis_min = 0.5, axis_max = 1.5;  ///< superellipsoid: semi-axes over the radius
  std::string axes_times =
      "one";  ///< superellipsoid: one | sizes; what the semi-axes are scaled by
  double exponent_min = 0.7, exponent_max = 1.3;  ///< superellipsoid

  // -- where they are
  std::string boundary = "periodic";  ///< periodic | walls
  double height_ratio = 1;            ///< edge along the last axis over the others, at the start
  double start_fraction = 0.3;        ///< solid fraction of the loose grains
  std::string filling = "placed";     ///< placed | dropped (walls, 3D)
  double base_fraction = 0.6;         ///< dropped: solid fraction that the base is made for
  double drop_gravity = 9.81;         ///< dropped: m/s2, downwards
  double drop_damping = 10;           ///< dropped: 1/s, of all motion
  std::string gap = "hanging";        ///< dropped: hanging | fitted, the spheres below the lid

  // -- compression
  std::string compression = "isotropic";  ///< isotropic | uniaxial (along the last axis)
  std::string compress_to = "pressure";   ///< pressure | solid_fraction | strain | none (dropped)
  double pressure = 1e4;                  ///< Pa (2D: N/m); of servos
  double solid_fraction = 0.86;           ///< compress_to solid_fraction
  double compression_strain = 0.2;        ///< compress_to strain: of every edge that shortens
  double compression_rate = 1;            ///< 1/s, of an edge; and of servos at most
  std::string prepared_with = "same_friction";  ///< same_friction | other_friction
  double prepared_friction = 0;  ///< other_friction: of the grains, and of walls at most
  double precompression = 0;     ///< strain along the last axis before the first state
  std::string settle = "rest";   ///< rest | none: between precompression and first state

  // -- small strains
  std::string probe = "none";  ///< none | prepared | first | both: the states they are tried in
  double probe_strain = 1e-5;

  // -- deformation
  std::string deformation = "simple_shear";  ///< simple_shear | axial | uniaxial | isotropic
  std::string constant = "volume";           ///< simple_shear: volume | stress (of the lid)
  std::string sides = "tilting";             ///< simple_shear between walls: tilting | upright
  double strain = 0.5, strain_rate = 0.1;    ///< -, 1/s
  double ramp_time = 0.05;                   ///< s from rest to the full rate; walls
  int records = 20;                          ///< recorded states after the first one

  // -- and back
  std::string unload = "none";  ///< none | strain | stress
  double unload_strain = 1;     ///< strain: the share of it that is taken back
  double unload_stress = 1;     ///< stress: down to this share of the first state's axial stress
  int unload_records = 10;      ///< recorded states of the unloading

  auto members() const {
    return std::tie(dim, shape, grains, sizes, radius, polydispersity, size_ratio, fraction_small,
                    corners_min, corners_max, axis_min, axis_max, axes_times, exponent_min,
                    exponent_max, boundary, height_ratio, start_fraction, filling, base_fraction,
                    drop_gravity, drop_damping, gap, compression, compress_to, pressure,
                    solid_fraction, compression_strain, compression_rate, prepared_with,
                    prepared_friction, precompression, settle, probe, probe_strain, deformation,
                    constant, sides, strain, strain_rate, ramp_time, records, unload, unload_strain,
                    unload_stress, unload_records);
  }
};

/// Grains in a periodic cell or between walls are compressed, rest and are deformed, without
/// gravity: compress -> rest -> snapshot "state_000" -> deform, with a snapshot "state_NNN" at each
/// of `records` equal steps of strain. Where the plan asks for it: after the rest the grains take
/// the friction of the material, shorten along the last axis and rest again; and after the last
/// strain the deformation is taken back, with `unload_records` further states.
struct SampleSetup {
  SamplePlan plan;
  MaterialSetup material = [] {
    MaterialSetup m;
    m.law = "linear";
    return m;
  }();
  MotionSetup motion;
  RestSetup rest = [] {
    RestSetup r;
    r.unbalanced_force_ratio = 1e-3;
    r.kinetic_to_elastic_energy = 1e-6;
    r.background_damping = 10;
    return r;
  }();

  auto members() const { return std::tie(plan, material, motion, rest); }
};

}  // namespace grainfield::dem
