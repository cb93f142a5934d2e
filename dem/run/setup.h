// Plain settings that studies share: when grains are at rest. SI.
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

}  // namespace grainfield::dem
