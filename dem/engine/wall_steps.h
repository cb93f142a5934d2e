// Walls that move: by one thread, while the grains stand still (advance, between the sweeps of two
// steps) or after they have asked for all that moves them (feel).
#pragma once
#include <algorithm>
#include <limits>

#include "dem/engine/contact_forces.h"
#include "dem/engine/world.h"

namespace grainfield::dem {

template <class World>
class WallSteps {
 public:
  static constexpr int dim = World::dim;

  explicit WallSteps(World& world) : world_(world) {}

  /// The torques on a wall in the books of the last step, about a centre from which it is `way` to
  /// the former one.
  void move_torques(int wall, const typename World::Vector& way) {
    if (!world_.balance.on) return;
    const auto& list = world_.contacts.walls;
    for (int k = 0; k < list.size(); ++k) {
      if (world_.walls.wall_of(list[k].j) != wall) continue;
      auto& parts = world_.balance.walls[k].before;
      for (ContactForce<dim>* f : {&parts.all, &parts.dashpot, &parts.along}) {
        f->torque_j += torque_of(way, typename World::Vector(-f->force));
      }
    }
  }
  /// Before step `step`.
  void advance(long step) {
    if (!world_.walls.any_driven()) return;
    world_.walls.advance(static_cast<double>(step) * world_.time_step, world_.time_step);
  }
  /// A wall's next step may take it out of its margin: before it there has to be a search.
  bool leave_margins() const {
    return world_.walls.any_driven() && world_.walls.leaves_margin(world_.time_step);
  }
  /// What the grains have done to the walls in the step that has ended, in the list's order.
  void feel() {
    auto& walls = world_.walls;
    if (!walls.any_driven()) return;
    const auto& contacts = world_.contacts;
    walls.clear_forces();
    for (int i = 0; i < contacts.walls.rows(); ++i) {
      for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
        const int slot = contacts.walls[k].j, wall = walls.wall_of(slot);
        auto f = contacts.wall_forces[k];
        if (!walls.is_driven(wall) || contacts.wall_normals[k].isZero(0)) continue;
        if (world_.added.on()) [[unlikely]] {
          AddedLoads<dim>::add(world_.added.at(wall_key(world_.grains.ids[i], slot), false), false,
                               f);
        }
        const double stiffness = walls.state(wall).servo.on != 0 ? stiffness_at(i, slot) : 0;
        walls.add_force(wall, -f.force, f.torque_j, stiffness, world_.grains.inertias[i].mass);
      }
    }
    walls.finish_forces(world_.time_step);
  }
  void check_speeds() {
    if (speeds_checked_ && checked_grains_ == world_.grains.size()) return;
    speeds_checked_ = true;
    checked_grains_ = world_.grains.size();
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < world_.grains.size(); ++i) {
      if (!world_.grains.is_fixed(i)) least = std::min(least, world_.grains.bodies[i].radius);
    }
    world_.walls.check_speeds(kMaxMoveShare * least, world_.time_step);
  }
  /// Speeds are checked again before the next step.
  void forget() { speeds_checked_ = false; }
  /// By how much the force of a contact may answer a wall that moves by a metre in a step: the
  /// law's stiffness, and a dashpot. The law tells the decay rate of six neighbours, each with half
  /// a grain's effective mass; a wall is one, with all of it: c is at most a third of m rate.
  double stiffness_at(int i, int slot) const {
    const auto& law = world_.wall_rule(i, slot).law;
    const double mass = world_.grains.inertias[i].mass, radius = world_.grains.bodies[i].radius;
    double rate = 0;
    if constexpr (requires { law.normal_rate(mass, radius); }) {
      rate = law.normal_rate(mass, radius);
    } else {
      rate = law.viscous_rate(mass, radius);
    }
    return law.stiffness(radius) + 2.0 / 3 * mass * rate / world_.time_step;
  }

 private:
  World& world_;
  bool speeds_checked_ = true;  // of the walls that move, with so many grains
  int checked_grains_ = 0;
};

}  // namespace grainfield::dem
