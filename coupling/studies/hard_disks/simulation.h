// A gas of equal hard disks or spheres: its pressure, or how it cools.
#pragma once
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "dem/run/outlook.h"
#include "dem/run/run.h"

namespace grainfield::dem {

/// For every fraction in turn: grains on a lattice with velocities that are drawn collide without
/// loss until they are mixed; then the pressure is measured, or they lose energy and cool.
struct HardParticlesSetup {
  std::string shape = "disk";     ///< disk | sphere
  std::string kind = "pressure";  ///< pressure | cooling
  int grains = 10000;
  double radius = 1e-3;                           ///< m
  double density = 2500;                          ///< kg/m2, of spheres kg/m3
  double speed = 1;                               ///< root mean square of each component, m/s
  std::vector<double> fractions{0.2, 0.35, 0.5};  ///< of the box that grains fill
  double equilibration = 50;  ///< collisions a grain before anything is measured
  double collisions = 400;    ///< pressure: collisions a grain that are measured
  double restitution = 0.9;   ///< cooling: below 1
  double friction = 0;        ///< cooling: Coulomb
  double contact_time = 0;    ///< cooling: s (dem/collisions/hard_engine.h); 0: none
  double cool_to = 0.02;      ///< cooling: share of the temperature that Haff's law ends with
  int records = 40;           ///< cooling: rows of the curve

  auto members() const {
    return std::tie(shape, kind, grains, radius, density, speed, fractions, equilibration,
                    collisions, restitution, friction, contact_time, cool_to, records);
  }
  bool is_3d() const { return shape == "sphere"; }
};

/// Columns of a cooling gas: table "gas" of each snapshot, pure numbers. time:
/// over Haff's; temperature and that of the spins: over the one at the start; collisions: of a
/// grain.
inline constexpr const char* kCoolingColumns[] = {"time", "temperature", "spin_temperature",
                                                  "collisions"};

/// "fraction_0.35", the name of that fraction's snapshot; figures begin with "gas.fraction_0.35.".
std::string name_of_fraction(double fraction);

/// Throws std::invalid_argument naming the key.
std::unique_ptr<Run> make_hard_particles_run(const HardParticlesSetup& setup, std::uint64_t seed);
/// The same refusals.
Outlook foresee_hard_particles(const HardParticlesSetup& setup);

}  // namespace grainfield::dem
