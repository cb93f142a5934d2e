// Velocity Verlet (Roul 2.19 as corrected): half kick, drift, forces, half kick. Forces see the
// velocity at the half step.
#pragma once
#include "dem/space/body.h"

namespace grainfield::dem {

class VerletIntegrator {
 public:
  /// Per grain: angle and acceleration.
  struct Memory {
    double angle = 0, ax = 0, ay = 0, aspin = 0;
  };
  static constexpr const char* name = "verlet";

  explicit VerletIntegrator(double dt) : dt_(dt) {}

  /// Of a grain that has not moved yet: its acceleration where it stands.
  void start(Memory& m, double ax, double ay, double aspin) const {
    m.ax = ax;
    m.ay = ay;
    m.aspin = aspin;
  }
  /// Before the forces: moves the grain.
  void begin(Body& b, Memory& m) const {
    const double half = 0.5 * dt_;
    b.vx += half * m.ax;
    b.vy += half * m.ay;
    b.spin += half * m.aspin;
    b.x += dt_ * b.vx;
    b.y += dt_ * b.vy;
    m.angle += dt_ * b.spin;
  }
  /// After the forces: accelerations at the new position.
  void end(Body& b, Memory& m, double ax, double ay, double aspin) const {
    const double half = 0.5 * dt_;
    m.ax = ax;
    m.ay = ay;
    m.aspin = aspin;
    b.vx += half * ax;
    b.vy += half * ay;
    b.spin += half * aspin;
  }

 private:
  double dt_;
};

}  // namespace grainfield::dem
