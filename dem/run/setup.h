// Plain settings that studies share: when grains are at rest, and when they sleep. SI.
#pragma once
#include <tuple>

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

}  // namespace grainfield::dem
