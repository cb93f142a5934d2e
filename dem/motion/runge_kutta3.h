// Leapfrog in place and classical fourth-order Runge-Kutta in rotation, in three dimensions
// (Wellmann, Lillie and Wriggers, section 2).
//
// Over a step the rotation q (a quaternion) and the spin w in the body frame follow
//   q' = q (0, w)/2,   I w' = q* M q - w x I w
// from where they stand, with four evaluations. M is the torque of the forces at the step, held in
// space while the body turns: so the angular momentum grows by M dt, and what two grains give each
// other adds up to nothing; held in the body it would turn with each of them. At the step's end
// half of M dt is exchanged for half of the new torque's, as leapfrog exchanges accelerations: the
// motion in forces that change with place is of second order, as in verlet3.h, and forces see the
// velocity and the spin of the half step. Free turning is of fourth order; it
// is not symplectic: energy and angular momentum of a free body drift, by the fourth order, too.
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
    const Turn now{m.rotation.coeffs(), m.rotation.conjugate() * b.spin};
    const Turn after = turned(now, m.torque, inertia.moments);
    m.rotation.coeffs() = after.rotation;
    m.rotation.normalize();
    // The half of the torque that belongs to the step's end is given by `end`.
    const Vector momentum = m.rotation * Vector(inertia.moments.cwiseProduct(after.spin));
    const Vector half = m.rotation.conjugate() * Vector(momentum - 0.5 * dt_ * m.torque);
    b.spin = m.rotation * Vector(half.cwiseQuotient(inertia.moments));
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
  static Turn rate_of(const Turn& at, const Vector& torque, const Vector& moments) {
    RotationOf<3> q, w(0, at.spin.x(), at.spin.y(), at.spin.z());
    q.coeffs() = at.rotation;
    const Vector momentum = moments.cwiseProduct(at.spin);
    const Vector in_body = q.conjugate() * torque;
    return {0.5 * (q * w).coeffs(), (in_body - at.spin.cross(momentum)).cwiseQuotient(moments)};
  }
  Turn turned(const Turn& start, const Vector& torque, const Vector& moments) const {
    const auto moved = [&](const Turn& rate, double dt) {
      return Turn{start.rotation + dt * rate.rotation, start.spin + dt * rate.spin};
    };
    const auto rate = [&](const Turn& at) { return rate_of(at, torque, moments); };
    const Turn a = rate(start), b = rate(moved(a, 0.5 * dt_)), c = rate(moved(b, 0.5 * dt_)),
               d = rate(moved(c, dt_));
    return moved({a.rotation + 2 * (b.rotation + c.rotation) + d.rotation,
                  a.spin + 2 * (b.spin + c.spin) + d.spin},
                 dt_ / 6);
  }

  double dt_;
  VerletIntegrator<3> leap_;
};

}  // namespace grainfield::dem
