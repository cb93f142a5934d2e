// A lattice pile of soft disks that settles under implicit motion (dem/implicit/soft_disks.h).
#pragma once
#include <memory>
#include <string>
#include <tuple>

#include "dem/grains/lattice_pile.h"
#include "dem/run/outlook.h"
#include "dem/run/run.h"

namespace grainfield::dem {

/// Dashpots in units of sqrt(m K), the critical one's half; times in units of sqrt(d/g).
struct ImplicitSettlingSetup {
  LatticeSetup lattice;
  double density = 5000;              ///< kg/m2
  double gravity = 9.81;              ///< m/s2
  double softness = 1e-4;             ///< m g/(K d)
  double damping = 0.2;               ///< K_D/sqrt(m K)
  std::string friction = "viscous";   ///< none | viscous | coulomb
  double slip_damping = 0.5;          ///< K_slip/sqrt(m K)
  double rolling_friction = 0.9;      ///< mu_roll of viscous
  double coulomb = 0.9;               ///< mu of coulomb
  double tangential_ratio = 2.0 / 7;  ///< k_t/K of coulomb
  double static_friction = 1;         ///< mu_static of the ground's wells; 0: none
  double well = 1e-3;                 ///< their half width a/d
  bool base_spins = false;            ///< the lowest row may roll
  std::string scheme = "conserving";  ///< conserving | bdf2
  double step = 10;                   ///< time step over (1/10) pi sqrt(m/K)
  double relaxation = 1;              ///< dem/implicit/soft_disks.h
  double tolerance = 1e-12;           ///< likewise
  int max_iterations = 50;            ///< likewise
  double rest = 1e-8;                 ///< mean resultant / mean contact force that ends the run
  double max_time = 60;               ///< sqrt(d/g); ends it as well
  int records = 300;                  ///< rows of the curves over max_time

  auto members() const {
    return std::tie(lattice, density, gravity, softness, damping, friction, slip_damping,
                    rolling_friction, coulomb, tangential_ratio, static_friction, well, base_spins,
                    scheme, step, relaxation, tolerance, max_iterations, rest, max_time, records);
  }
  double mass() const;                                            ///< kg
  double weight() const;                                          ///< N
  double stiffness() const;                                       ///< K, N/m
  double time_step() const;                                       ///< s
  double time_unit() const;                                       ///< sqrt(d/g), s
  double longest_time() const { return max_time * time_unit(); }  ///< s
};

/// Columns of the curves: table "settling" of the snapshot.
/// time: in sqrt(d/g); energies in m g d: kinetic, elastic, lost since the start by dashpots along
/// the normal, by friction, by wells and by BDF2 itself, and what is missing of the balance;
/// iterations: of Newton's method per solve since the last row; spread: by how much the outermost
/// base disks have parted, in d; normal_error, horizontal_error: the largest difference of a base
/// disk's N and H from those of hard disks, over the largest one.
inline constexpr const char* kSettlingColumns[] = {
    "time",         "kinetic",         "elastic",    "lost_normal", "lost_tangential",
    "lost_well",    "lost_scheme",     "unbalanced", "iterations",  "spread",
    "normal_error", "horizontal_error"};

/// Snapshot "pile" at the end, at rest or after max_time, the lowest row first. Throws
/// std::invalid_argument naming the key.
std::unique_ptr<Run> make_implicit_settling_run(const ImplicitSettlingSetup& setup,
                                                std::uint64_t seed);
/// The same refusals.
Outlook foresee_implicit_settling(const ImplicitSettlingSetup& setup);

}  // namespace grainfield::dem
