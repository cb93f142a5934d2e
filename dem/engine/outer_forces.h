// What acts on a grain beside contacts and weight: Cundall's local damping, and the energy account
// of damping, drag, the applied force and forces of the caller's own.
#pragma once
#include "dem/engine/world.h"
#include "dem/motion/local_damping.h"

namespace grainfield::dem {

template <class World>
class OuterForces {
 public:
  static constexpr int dim = World::dim;
  using Vector = typename World::Vector;

  explicit OuterForces(World& world) : world_(world), local_damping_(world.local_damping) {}

  bool damps() const { return local_damping_ > 0; }

  struct Damping {
    Vector force = zero<Vector>();
    SpinOf<dim> torque = zero<SpinOf<dim>>();
  };
  /// Cundall's, of all other forces on a grain.
  [[gnu::noinline]] Damping damping(int i, const Vector force, const SpinOf<dim> torque) const {
    const auto& b = world_.grains.bodies[i];
    return {local_damping(Vector(force + world_.weight(i)), Vector(world_.fluctuation(i)),
                          local_damping_),
            local_damping(torque, b.spin, local_damping_)};
  }

  /// Damping and the applied force on a grain, before its step ends, or (dt = 0) before its first
  /// one begins. `local`: its local damping.
  [[gnu::noinline]] void record(int i, Vector applied, const Damping& local, double dt) {
    auto& account = world_.balance.outer[world_.grains.ids[i]];
    const auto& b = world_.grains.bodies[i];
    const Vector velocity = world_.fluctuation(i);  // damping is against the flow
    const double rate = world_.around.drag;
    const Vector drag = rate * world_.grains.inertias[i].mass * velocity - local.force;
    SpinOf<dim> turning = zero<SpinOf<dim>>();
    if (b.inverse_inertia > 0) {
      turning = rate * angular_momentum_of(b, world_.rotation(i), world_.grains.inertias[i]) -
                local.torque;
    }
    account.damped += 0.5 * dt *
                      (Vector(account.drag + drag).dot(velocity) +
                       power_of(SpinOf<dim>(account.drag_torque + turning), b.spin));
    const auto added = world_.added.of(world_.grains.ids[i]);
    applied += added.force;
    account.work += 0.5 * dt *
                    (Vector(account.applied + applied).dot(b.velocity) +
                     power_of(SpinOf<dim>(account.applied_torque + added.torque), b.spin));
    account.drag = drag;
    account.drag_torque = turning;
    account.applied = applied;
    account.applied_torque = added.torque;
  }

 private:
  World& world_;
  const double local_damping_;  // Cundall's alpha
};

}  // namespace grainfield::dem
