// How motion is integrated.
#pragma once
#include <string>
#include <tuple>

namespace grainfield::dem {

struct MotionSetup {
  std::string integrator = "verlet";  ///< verlet | gear (same results, ten times shorter steps)
  double time_step = 0;               ///< s; 0 = time_step_fraction of the stable limit
  double time_step_fraction = 0.8;    ///< of the stable limit (engine.h: stable_time_step)
  double local_damping = 0;           ///< Cundall's alpha (local_damping.h), -
  bool energy_balance = false;        ///< contacts account for where energy goes (energy_balance.h)

  auto members() const {
    return std::tie(integrator, time_step, time_step_fraction, local_damping, energy_balance);
  }
};

}  // namespace grainfield::dem
