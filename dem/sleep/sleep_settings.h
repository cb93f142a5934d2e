// Who may sleep, and what wakes a sleeper.
#pragma once

namespace grainfield::dem {

/// Grains at rest may sleep: their places are frozen, contacts between them keep their forces, and
/// the cost of a step follows the grains in motion. A sleeper wakes when the forces from its moving
/// neighbours leave it out of balance, or when one of them touches it at speed.
struct SleepSettings {
  bool on = false;
  double quiet_time = 1e-2;  ///< s that a grain must be quiet; longer: fewer errors, more awake
  double quiet_move = 8e-4;  ///< quiet: moved less than this share of its diameter in quiet_time
  double quiet_force = 0.1;  ///< quiet: resultant below this share of the forces on it
  double wake_force = 0.15;  ///< wakes: resultant above this share of the forces on it
  double wake_speed = 0.5;   ///< wakes: touched at more than this times sqrt(g d), ...
  double wake_reach = 2;  ///< ... or within this times d v / sqrt(g d) of a grain at such a speed v
};

}  // namespace grainfield::dem
