// Leapfrog in place and classical fourth-order Runge-Kutta in rotation, in three dimensions
// (Wellmann, Lillie and Wriggers, section 2).
//
// Between two steps a body turns freely: its rotation q (a quaternion) and the spin w in its own
// frame follow Euler's equations,
//   q' = q (0, w)/2,   I w' = -w x I w,
// with four evaluations. The torque M of the forces at a step acts there, as leapfrog's force does:
// the angular momentum gets half of M dt before the turn and half of the new torque's after it, so
// forces see velocity and spin of the half step. It acts in space: there the torques that two
// grains give each other add up to nothing, whichever way each of them turns. Held inside the four
// evaluations instead, as a constant of space, the torque would make a step that is not the same
// backwards, and a body in a potential would gain energy at the third power of dt without bound.
//
// Second order with torques that change with place; free turning has the fourth. It is not
// symplectic: energy and angular momentum of a free body drift, by the fourth order too.
#pragma once
#include "dem/motion/runge_kutta.h"
#include "dem/motion/verlet3.h"

namespace grainfield::dem {

template <>
class RungeKuttaIntegrator<3> {
 public:
  static constexpr bool end_moves = false;
  using Vector = Eigen::Vector3d;
  using Memory = VerletIntegrator<3>::Memory;

  explicit RungeKuttaIntegrator(double dt) : dt_(dt), leap_(dt) {}

  void start(const Body<3>& b, Memory& m, const Inertia<3>& inertia, const Load<3>& load) const {
    leap_.start(b, m, inertia, load);
  }
  void begin(Body<3>& b, Memory& m, const Inertia<3>& inertia) const {
    b.velocity += 0.5 * dt_ * m.acceleration;
    b.position += dt_ * b.velocity;
    if (b.inverse_inertia == 0) return;  // does not turn
    const Vector& moments = inertia.moments;
    const Vector kick = m.rotation.conjugate() * Vector(0.5 * dt_ * m.torque);
    const Vector spin = m.rotation.conjugate() * b.spin;
    const Turn after = turned({m.rotation.coeffs(), spin + kick.cwiseQuotient(moments)}, moments);
    m.rotation.coeffs() = after.rotation;
    m.rotation.normalize();
    b.spin = m.rotation * after.spin;
  }
  void end(Body<3>& b, Memory& m, const Inertia<3>& inertia, const Load<3>& load) const {
    leap_.end(b, m, inertia, load);
  }

 private:
  /// Rotation (x, y, z, w) and spin in the body frame, or their rates.
  struct Turn {
    Eigen::Vector4d rotation;
    Vector spin;
  };
  static Turn rate_of(const Turn& at, const Vector& moments) {
    RotationOf<3> q, w(0, at.spin.x(), at.spin.y(), at.spin.z());
    q.coeffs() = at.rotation;
    const Vector momentum = moments.cwiseProduct(at.spin);
    return {0.5 * (q * w).coeffs(), momentum.cross(at.spin).cwiseQuotient(moments)};
  }
  Turn turned(const Turn& start, const Vector& moments) const {
    const auto moved = [&](const Turn& rate, double dt) {
      return Turn{start.rotation + dt * rate.rotation, start.spin + dt * rate.spin};
    };
    const Turn a = rate_of(start, moments), b = rate_of(moved(a, 0.5 * dt_), moments),
               c = rate_of(moved(b, 0.5 * dt_), moments), d = rate_of(moved(c, dt_), moments);
    return moved({a.rotation + 2 * (b.rotation + c.rotation) + d.rotation,
                  a.spin + 2 * (b.spin + c.spin) + d.spin},
                 dt_ / 6);
  }

  double dt_;
  VerletIntegrator<3> leap_;
};

}  // namespace grainfield::dem
