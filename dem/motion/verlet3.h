// Velocity Verlet in three dimensions: as in the plane, with turning by a symplectic splitting.
//
// The angular momentum L gets half a kick of torque before and after the drift. The drift of a free
// body is split into turns about its principal axes, x y z y x by half, half, whole, half, half
// steps of the rate L_k/I_k (Dullweber, Leimkuhler and McLachlan 1997): second order, reversible,
// |L| kept to round-off; what it leaves out of the exact motion is the gyroscopic term's third
// order. Where all moments are equal the body simply turns by dt omega.
#pragma once
#include "dem/motion/turn_lanes.h"
#include "dem/motion/verlet.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

inline bool is_round(const Inertia<3>& inertia) {
  const Eigen::Vector3d& i = inertia.moments;
  return i[0] == i[1] && i[1] == i[2];
}
/// Angular momentum, kg m2/s; 0 of a body that does not turn.
inline Eigen::Vector3d angular_momentum_of(const Body<3>& b, const RotationOf<3>& rotation,
                                           const Inertia<3>& inertia) {
  if (b.inverse_inertia == 0) return Eigen::Vector3d::Zero();
  if (is_round(inertia)) return inertia.moments[0] * b.spin;
  const Eigen::Vector3d in_body = rotation.conjugate() * b.spin;
  return rotation * inertia.moments.cwiseProduct(in_body);
}

template <>
class VerletIntegrator<3> {
 public:
  static constexpr bool end_moves = false;
  static constexpr bool in_lanes = true;  ///< begins several bodies at a time, too
  using Vector = Eigen::Vector3d;

  /// Per grain: rotation, acceleration, and torque with the drag's part (N m).
  struct Memory {
    RotationOf<3> rotation = RotationOf<3>::Identity();
    Vector acceleration = Vector::Zero();
    Vector torque = Vector::Zero();
  };

  explicit VerletIntegrator(double dt) : dt_(dt) {}

  void start(const Body<3>& b, Memory& m, const Inertia<3>& inertia, const Load<3>& load) const {
    m.acceleration = acceleration_of(b, load);
    m.torque = load.torque - load.drag * angular_momentum_of(b, m.rotation, inertia);
  }
  void begin(Body<3>& b, Memory& m, const Inertia<3>& inertia) const {
    b.velocity += 0.5 * dt_ * m.acceleration;
    b.position += dt_ * b.velocity;
    if (b.inverse_inertia == 0) return;  // does not turn
    if (is_round(inertia)) {
      b.spin += (0.5 * dt_ * b.inverse_inertia) * m.torque;
      m.rotation = quaternion_of(dt_ * b.spin) * m.rotation;
      // It is off 1 by round-off alone, of which one Newton step leaves nothing.
      m.rotation.coeffs() *= 1.5 - 0.5 * m.rotation.squaredNorm();
    } else {
      drift(b, m, inertia);
      m.rotation.normalize();
    }
  }
  /// begin of several bodies: body(k), memory(k) and inertia(k) are those of the k-th. Bit by bit
  /// as one by one.
  template <class BodyAt, class MemoryAt, class InertiaAt>
  void begin(int count, BodyAt body, MemoryAt memory, InertiaAt inertia) const {
    TurnBatch batch;
    int turning[kBatch], size = 0;
    for (int k = 0; k < count; ++k) {
      Body<3>& b = body(k);
      Memory& m = memory(k);
      const Inertia<3>& i = inertia(k);
      if (b.inverse_inertia == 0 || is_round(i)) {
        begin(b, m, i);
        continue;
      }
      b.velocity += 0.5 * dt_ * m.acceleration;
      b.position += dt_ * b.velocity;
      for (int d = 0; d < 3; ++d) {
        batch.spin[d][size] = b.spin[d];
        batch.torque[d][size] = m.torque[d];
        batch.moments[d][size] = i.moments[d];
      }
      for (int d = 0; d < 4; ++d) batch.rotation[d][size] = m.rotation.coeffs()[d];
      turning[size++] = k;
    }
    drift_turning(batch, dt_, size);
    for (int n = 0; n < size; ++n) {
      for (int d = 0; d < 3; ++d) body(turning[n]).spin[d] = batch.spin[d][n];
      for (int d = 0; d < 4; ++d) memory(turning[n]).rotation.coeffs()[d] = batch.rotation[d][n];
    }
  }
  void end(Body<3>& b, Memory& m, const Inertia<3>& inertia, const Load<3>& load) const {
    start(b, m, inertia, load);
    b.velocity += 0.5 * dt_ * m.acceleration;
    if (b.inverse_inertia == 0) return;
    if (is_round(inertia)) {
      b.spin += (0.5 * dt_ * b.inverse_inertia) * m.torque;
    } else {
      const Vector momentum = angular_momentum_of(b, m.rotation, inertia) + 0.5 * dt_ * m.torque;
      b.spin = spin_of(m.rotation.conjugate() * momentum, m, inertia);
    }
  }

 private:
  /// From the angular momentum in the body frame.
  static Vector spin_of(const Vector& momentum, const Memory& m, const Inertia<3>& inertia) {
    return m.rotation * momentum.cwiseQuotient(inertia.moments);
  }
  void drift(Body<3>& b, Memory& m, const Inertia<3>& inertia) const {
    const Vector world = angular_momentum_of(b, m.rotation, inertia) + 0.5 * dt_ * m.torque;
    Vector momentum = m.rotation.conjugate() * world;
    const auto turn = [&](int axis, double dt) {
      const Vector by = dt * momentum[axis] / inertia.moments[axis] * Vector::Unit(axis);
      const RotationOf<3> q = quaternion_of(by);
      momentum = q.conjugate() * momentum;
      m.rotation = m.rotation * q;
    };
    turn(0, 0.5 * dt_);
    turn(1, 0.5 * dt_);
    turn(2, dt_);
    turn(1, 0.5 * dt_);
    turn(0, 0.5 * dt_);
    b.spin = spin_of(momentum, m, inertia);
  }

  double dt_;
};

}  // namespace grainfield::dem
