// Who may sleep, and what wakes a sleeper.
//
// The load of a grain is half the sum of the lengths of all forces on it, its weight too; what is
// out of balance is the length of their resultant and that of their moment over the radius. Ways
// are the centroid's and, added to them, the rim's about it, against what the grain touches: a pile
// that swings as a whole strains no contact. Nothing of it depends on the axes.
#pragma once
#include <tuple>

namespace grainfield::dem {

/// Grains at rest may sleep: their places are frozen, contacts between them keep their forces, and
/// the cost of a step follows the grains in motion. A sleeper wakes when the forces from its moving
/// neighbours leave it out of balance for long or by much, when one of them touches it at speed, or
/// for a look, when what is left out of balance would have moved it.
struct SleepSettings {
  bool on = false;
  double quiet_time = 1e-3;     ///< s that a grain must be quiet; longer: fewer errors, more awake
  double quiet_move = 8e-4;     ///< quiet: moved less than this share of its diameter in quiet_time
  double quiet_creep = 0.05;    ///< sleeps: has crept by less than this, diameters/s, while quiet
  double quiet_force = 0.01;    ///< sleeps: out of balance by less than this share of its load
  double wake_force = 0.015;    ///< wakes: out of balance by more than this share of its load, ...
  double wake_time = 0.05;      ///< s: ... in the mean of about this time, ...
  double wake_shock = 0.5;      ///< ... or by more than this share at once
  double wake_levels = 0.0075;  ///< wakes all: a level misses more than this share of its load
  double wake_speed = 0.5;      ///< wakes: touched at more than this times sqrt(g d), ...
  double wake_reach = 2;  ///< ... or within this times d v / sqrt(g d) of a grain at such a speed v

  auto members() const {
    return std::tie(on, quiet_time, quiet_move, quiet_creep, quiet_force, wake_force, wake_time,
                    wake_shock, wake_levels, wake_speed, wake_reach);
  }
};

}  // namespace grainfield::dem
