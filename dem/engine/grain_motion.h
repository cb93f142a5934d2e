// The motion of grains: the end of a step and the beginning of the next, in a space that flows,
// too, and whether one has left its margin.
#pragma once
#include "dem/engine/flatten.h"
#include "dem/engine/world.h"
#include "dem/motion/load.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// Grains that begin their next step, together where that is in lanes.
struct Begins {
  bool moved = false;  ///< one has left its margin
  int waiting = 0, list[kBatch];
};

template <class World>
class GrainMotion {
 public:
  static constexpr int dim = World::dim;
  using Vector = typename World::Vector;
  using Body = typename World::Body;

  explicit GrainMotion(World& world) : world_(world), integrator_(world.time_step) {}

  /// The acceleration of a grain that is new.
  void start(int i, Load<dim> load) {
    auto& grains = world_.grains;
    auto& b = grains.bodies[i];
    load.gravity += load.drag * world_.cell.flow_at(b.position);
    integrator_.start(b, grains.memory[i], grains.inertias[i], load);
  }
  void end(int i, const Load<dim>& load) {
    auto& grains = world_.grains;
    integrator_.end(grains.bodies[i], grains.memory[i], grains.inertias[i], load);
  }
  /// With the drag against the flow, the rest of the acceleration that goes with the flow, and the
  /// flow's work on the grain:
  ///   d/dt (kinetic energy of the fluctuations u + elastic energy)
  ///     = sum over contacts f . G l - sum over grains m u . G u,
  /// written by grains (force F with its weight): -F . G x - m u . G u, and f . G n of the pairs
  /// that cross by edges n (ContactForces::pair_across). `local`: what of the load is local
  /// damping. It is against the flow and no part of that.
  [[gnu::noinline]] GRAINFIELD_FLATTEN void end_in_flow(int i, Load<dim> load, const Vector local) {
    auto& grains = world_.grains;
    const auto& cell = world_.cell;
    auto& b = grains.bodies[i];
    load.gravity += load.drag * cell.flow_at(b.position);
    integrator_.end(b, grains.memory[i], grains.inertias[i], load);
    // The edges' speed lacks its second half kick too, so that u is that of every image.
    const Vector flow = cell.flow_at(b.position), u = b.velocity - flow;
    b.velocity += cell.kick(b.position);
    const Vector force = load.force - local + world_.weight(i);
    grains.cell_work[i] -=
        world_.time_step * (force.dot(flow) + grains.inertias[i].mass * u.dot(cell.flow_of(u)) +
                            world_.weight(i).dot(cell.drift(grains.images[i])));
  }

  // The beginning of a step. True when the grain, or one of several, may have left its margin.

  bool begin(int i) {
    begin_unplaced(i);
    return has_left(i);
  }
  /// Its shape is placed later.
  bool begin_before_placing(int i) {
    begin_unplaced(i);
    return is_left(i);
  }
  [[gnu::noinline]] GRAINFIELD_FLATTEN bool begin_all(const int* list, int count) {
    auto& grains = world_.grains;
    const bool flows = world_.cell.flows();
    if (flows) {
      for (int k = 0; k < count; ++k) {
        auto& b = grains.bodies[list[k]];
        b.velocity += world_.cell.kick(b.position);
      }
    }
    integrator_.begin(
        count, [&](int k) -> Body& { return grains.bodies[list[k]]; },
        [&](int k) -> auto& { return grains.memory[list[k]]; },
        [&](int k) -> const auto& { return grains.inertias[list[k]]; });
    bool moved = false;
    for (int k = 0; k < count; ++k) moved |= flows ? has_left_in_flow(list[k]) : has_left(list[k]);
    return moved;
  }
  [[gnu::noinline]] GRAINFIELD_FLATTEN bool begin_in_flow(int i) {
    auto& grains = world_.grains;
    const auto& cell = world_.cell;
    auto& b = grains.bodies[i];
    b.velocity += cell.kick(b.position);
    integrator_.begin(b, grains.memory[i], grains.inertias[i]);
    return has_left_in_flow(i);
  }
  /// Nobody looks at a grain that has begun its next step before all have.
  void place_waiting(Begins& begins) {
    auto& grains = world_.grains;
    using Grip = typename World::Integrator::Memory;
    static_assert(sizeof(Grip) % sizeof(double) == 0);
    grains.shapes.place_all(begins.list, begins.waiting, grains.bodies.data(),
                            &grains.memory.data()->rotation, sizeof(Grip) / sizeof(double));
    begins.waiting = 0;
  }

 private:
  void begin_unplaced(int i) {
    auto& grains = world_.grains;
    integrator_.begin(grains.bodies[i], grains.memory[i], grains.inertias[i]);
  }
  /// Whether a moved grain left its margin; its shape is placed, too.
  bool has_left(int i) {
    auto& grains = world_.grains;
    if constexpr (World::Shape::keeps_places) {
      grains.shapes.place(i, grains.bodies[i], grains.memory[i].rotation);
    }
    return is_left(i);
  }
  bool is_left(int i) const {
    const auto& grains = world_.grains;
    return world_.margins[i].template is_left<World::Shape::outlines>(grains.bodies[i].position,
                                                                      grains.memory[i].rotation);
  }
  bool has_left_in_flow(int i) {
    auto& grains = world_.grains;
    const auto& cell = world_.cell;
    const auto& b = grains.bodies[i];
    const auto& rotation = grains.memory[i].rotation;
    constexpr bool outlines = World::Shape::outlines;
    if constexpr (World::Shape::keeps_places) grains.shapes.place(i, b, rotation);
    const auto& margin = world_.margins[i];
    return margin.template is_left_in_flow<outlines>(
        b.position, rotation, cell.carried(margin.position), cell.strain(), b.radius);
  }

  World& world_;
  typename World::Integrator integrator_;
};

}  // namespace grainfield::dem
