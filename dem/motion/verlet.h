// Velocity Verlet (Roul 2.19 as corrected): half kick, drift, forces, half kick. Forces see the
// velocity at the half step.
#pragma once
#include "dem/motion/load.h"

namespace grainfield::dem {

template <int D>
class VerletIntegrator;

/// In the plane.
template <>
class VerletIntegrator<2> {
 public:
  static constexpr bool end_moves = false;
  /// Per grain: angle and acceleration.
  struct Memory {
    double rotation = 0;
    VectorOf<2> acceleration{0, 0};
    double spin_rate = 0;
  };

  explicit VerletIntegrator(double dt) : dt_(dt) {}

  /// Sets a grain's acceleration where it is, before it has moved.
  void start(const Body<2>& b, Memory& m, const Inertia<2>&, const Load<2>& load) const {
    m.acceleration = acceleration_of(b, load);
    m.spin_rate = spin_rate_of(b, load);
  }
  /// Before the forces: moves the grain.
  void begin(Body<2>& b, Memory& m, const Inertia<2>&) const {
    const double half = 0.5 * dt_;
    b.velocity += half * m.acceleration;
    b.spin += half * m.spin_rate;
    b.position += dt_ * b.velocity;
    m.rotation += dt_ * b.spin;
  }
  /// After the forces: accelerations at the new position.
  void end(Body<2>& b, Memory& m, const Inertia<2>&, const Load<2>& load) const {
    const double half = 0.5 * dt_;
    const VectorOf<2> acceleration = acceleration_of(b, load);
    const double spin_rate = spin_rate_of(b, load);
    m.acceleration = acceleration;
    m.spin_rate = spin_rate;
    b.velocity += half * acceleration;
    b.spin += half * spin_rate;
  }

 private:
  double dt_;
};

/// The kind, for the registry. Stable for dt * rate < 2, of which half is allowed, and for
/// c dt + k dt^2/2 < 2, of which 0.7 is.
struct Verlet {
  static constexpr const char* name = "verlet";
  static constexpr double viscous_limit = 1.0, edge_limit = 1.4;
  static constexpr bool bears_irregular_edges = true;
  static constexpr bool leaps = true;
  static constexpr bool moves_round = true;
  template <int D>
  using In = VerletIntegrator<D>;
};

}  // namespace grainfield::dem
