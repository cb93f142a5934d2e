// Hard disks that rain into a box, or are dropped onto a pile one at a time, turn soft grain by
// grain and come to rest (dem/switching/switching_disks.h).
#pragma once
#include <memory>
#include <string>
#include <tuple>

#include "dem/run/outlook.h"
#include "dem/run/run.h"

namespace grainfield::dem {

/// Units as in implicit_settling.h; d and m are those of the mean radius.
struct HardToSoftSetup {
  std::string source = "rain";  ///< rain | drop
  int columns = 20, rows = 15;  ///< rain: disks at the start, side by side and in height
  int grains = 968;             ///< drop: disks, one after the other
  double above = 2;     ///< drop: each falls from so far above the pile's highest point, diameters
  double interval = 3;  ///< drop: from one to the next, sqrt(d/g)
  double spread = 0.5;  ///< drop: within +- this from x = 0, radii
  double floor = 200;   ///< drop: length of the ground between the walls that catch strays,
                        ///< diameters
  double radius = 0.0045;             ///< m
  double polydispersity = 0.1;        ///< radii uniform in (1 -+ this) times the radius
  double clearance = 1;               ///< between rows, and below the lowest, in diameters
  double density = 5000;              ///< kg/m2
  double gravity = 9.81;              ///< m/s2
  double restitution = 0.5;           ///< of impulses
  double impact_friction = 0.3;       ///< likewise
  double softness = 1e-4;             ///< m g/(K d)
  double damping = 0.5;               ///< K_D/sqrt(m K)
  std::string friction = "coulomb";   ///< coulomb | viscous
  double coulomb = 0.3;               ///< mu of soft contacts
  double tangential_ratio = 2.0 / 7;  ///< k_t/K
  double slip_damping = 0.5;          ///< K_slip/sqrt(m K) of viscous
  double rolling_friction = 0.9;      ///< mu_roll of viscous
  double static_friction = 0;         ///< mu_static of the ground's wells; 0: none
  double well = 1e-3;                 ///< their half width a/d
  double step = 5;                    ///< time step over (1/10) pi sqrt(m/K)
  double rest = 1e-3;  ///< mean resultant / mean contact force of the soft grains that ends the run
  double max_time = 60;  ///< sqrt(d/g), after the last disk of a drop; ends it as well
  int records = 300;     ///< rows of the curves over max_time

  auto members() const {
    return std::tie(source, columns, rows, grains, above, interval, spread, floor, radius,
                    polydispersity, clearance, density, gravity, restitution, impact_friction,
                    softness, damping, friction, coulomb, tangential_ratio, slip_damping,
                    rolling_friction, static_friction, well, step, rest, max_time, records);
  }
  bool drops() const { return source == "drop"; }
  int disks() const { return drops() ? grains : columns * rows; }
  double mass() const;          ///< kg
  double weight() const;        ///< N
  double stiffness() const;     ///< K, N/m
  double time_step() const;     ///< s
  double time_unit() const;     ///< sqrt(d/g), s
  double width() const;         ///< of the box or the floor, m
  double drop_time() const;     ///< from the first disk of a drop to the last, s; rain: 0
  double longest_time() const;  ///< s
};

/// Columns of the curves: table "switch" of the snapshots. time: in sqrt(d/g);
/// soft: share of the grains; energies in m g d: kinetic, elastic with springs, lost by impulses
/// and by soft contacts, and what is missing of the balance.
inline constexpr const char* kSwitchColumns[] = {
    "time", "soft", "kinetic", "elastic", "lost_impulses", "lost_soft", "unbalanced"};

/// Snapshots "soft_25", "soft_50", "soft_75" of a rain, when that share of the grains, %, was soft
/// for the first time, and "pile". Table "soft": 1 for every soft grain, 0 for a hard
/// one, in the order of the grains. Throws std::invalid_argument naming the key.
std::unique_ptr<Run> make_hard_to_soft_run(const HardToSoftSetup& setup, std::uint64_t seed);
/// The same refusals.
Outlook foresee_hard_to_soft(const HardToSoftSetup& setup);

}  // namespace grainfield::dem
