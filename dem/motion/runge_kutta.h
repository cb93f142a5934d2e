// The kind of runge_kutta3.h, for the registry: in three dimensions alone, and for grains that are
// no spheres, whose turning it is for.
#pragma once

namespace grainfield::dem {

template <int D>
class RungeKuttaIntegrator;

/// Its limits are those of verlet.h, with which it shares all but the free turning.
struct RungeKutta {
  static constexpr const char* name = "runge_kutta";
  static constexpr double viscous_limit = 1.0, edge_limit = 1.4;
  static constexpr bool bears_irregular_edges = false;
  static constexpr bool leaps = true;
  static constexpr bool moves_round = false;
  template <int D>
  using In = RungeKuttaIntegrator<D>;
};

}  // namespace grainfield::dem
