// One step: forces of the pairs in a fixed order, then the motion of the grains (see engine.h for
// the algorithm).
#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

#include "dem/engine/world.h"
#include "dem/motion/load.h"

namespace grainfield::dem {

enum class SweepKind {
  start,    ///< only the acceleration of new grains
  move_on,  ///< end the step and begin the next
  last      ///< end the step and keep the forces for measure() and snapshot()
};

template <class World>
class Sweep {
 public:
  static constexpr int dim = World::dim;
  using Force = ContactForce<dim>;
  using Vector = typename World::Vector;

  explicit Sweep(World& world) : world_(world), integrator_(world.time_step) {}

  /// After a search: nothing has been added up yet.
  void reset() { sums_.assign(world_.grains.bodies.size(), Sum{}); }

  /// Some grain has left its margin since clear_moved().
  bool moved() const { return moved_.load(std::memory_order_relaxed); }
  void clear_moved() { moved_ = false; }

  /// Begins a step for all grains of a thread's block.
  [[gnu::flatten]] void begin_block(int rank) {
    bool moved = false;
    const Blocks& blocks = world_.contacts.blocks;
    for (int i = blocks.first(rank); i < blocks.last(rank); ++i) {
      if (world_.grains.bodies[i].inverse_mass != 0) begin(i, moved);
    }
    if (moved) moved_.store(true, std::memory_order_relaxed);
  }

  /// Pairs that reach from an earlier thread's block into this one's. They come first in the sum of
  /// their second grain, as they do when one thread sweeps all.
  [[gnu::flatten]] void incoming(int rank, double dt) {
    for (const auto& [i, k] : world_.contacts.blocks.incoming(rank)) {
      Force& f = world_.contacts.pair_forces[k];
      if (!pair_force(i, k, dt, f)) {
        f = Force{};
        continue;
      }
      Sum& sum = sums_[world_.contacts.pairs[k].j];
      sum.force -= f.force;
      sum.torque += f.torque_j;
    }
  }

  /// The sweep over a block: grain i is complete once its own pairs (i, j > i) are done, because
  /// those with j < i were done at j; so it moves at once and no later pair needs its old place.
  /// `applied`: the applied force. `first_new`: with SweepKind::start, ids from here on are new.
  /// Flattened: an overlap, a motion or a force that goes through memory to a function waits for
  /// its stores (a third of the time per step of 1,000 disks). Also begin_block and incoming, so
  /// that all of a step is compiled here, with one order of every sum.
  template <SweepKind kind>
  [[gnu::flatten]] void run(int rank, const Vector& applied, double dt,
                            std::int64_t first_new = 0) {
    auto& grains = world_.grains;
    auto& contacts = world_.contacts;
    auto& pairs = contacts.pairs;
    const int first = contacts.blocks.first(rank), last = contacts.blocks.last(rank);
    const int awake = world_.awake;
    bool moved = false;
    for (int i = first; i < last; ++i) {
      __builtin_prefetch(&grains.memory[i] + kAhead / 2, 1);
      Vector force = sums_[i].force;
      SpinOf<dim> torque = sums_[i].torque;
      sums_[i] = Sum{};
      const int end = pairs.last(i);
      for (int k = pairs.first(i); k < end; ++k) {
        const int j = pairs[k].j;
        const int later = pairs[k + kAhead].j;
        __builtin_prefetch(&grains.bodies[later], 1);
        __builtin_prefetch(&sums_[later], 1);
        Force f;
        if (j >= last && j < awake) {
          f = contacts.pair_forces[k];  // the block of j has evaluated it
        } else {
          const bool touches = pair_force(i, k, dt, f);
          if constexpr (kind == SweepKind::last) contacts.pair_forces[k] = f;
          if (!touches) continue;
          if (j < awake) {
            sums_[j].force -= f.force;
            sums_[j].torque += f.torque_j;
          } else if constexpr (kind != SweepKind::start) {
            // A sleeper, or fixed: it only remembers what it feels.
            Sum& felt = contacts.felt[k];
            felt.force += f.force;
            felt.torque += f.torque_j;
            felt.press += sum_of_sizes(f.force);
          }
        }
        force += f.force;
        torque += f.torque_i;
      }
      auto& b = grains.bodies[i];
      if (b.inverse_mass == 0) continue;
      walls<kind>(i, dt, force, torque);
      if (i == world_.applied_index) force += applied;
      const Load<dim> load{force, torque, world_.around.gravity, world_.around.drag};
      if constexpr (kind == SweepKind::start) {
        if (grains.ids[i] >= first_new) {
          integrator_.start(b, grains.memory[i], grains.inertias[i], load);
        }
      } else {
        integrator_.end(b, grains.memory[i], grains.inertias[i], load);
        if constexpr (kind == SweepKind::move_on) begin(i, moved);
      }
    }
    if (moved) moved_.store(true, std::memory_order_relaxed);
  }

 private:
  using Sum = ForceSum<dim>;

  void begin(int i, bool& moved) {
    auto& grains = world_.grains;
    auto& b = grains.bodies[i];
    auto& memory = grains.memory[i];
    integrator_.begin(b, memory, grains.inertias[i]);
    constexpr bool outlines = World::Shape::outlines;
    if constexpr (outlines) grains.shapes.place(i, b, memory.rotation);
    moved |= world_.margins[i].template is_left<outlines>(b.position, memory.rotation);
  }

  /// Force of pair k between grain i and its second one; 0 and an empty memory when they do not
  /// touch.
  bool pair_force(int i, int k, double dt, Force& force) {
    auto& pair = world_.contacts.pairs[k];
    const auto& grains = world_.grains;
    const auto &a = grains.bodies[i], &b = grains.bodies[pair.j];
    typename World::Overlap o;
    if (!world_.acting.overlap(grains.shapes, i, a, pair.j, b, pair.feature, o)) {
      pair.memory = {};
      return false;
    }
    force = world_.acting.force(world_.pair_rule(i, pair.j), a, b, o, dt, pair.memory);
    return true;
  }

  template <SweepKind kind>
  void walls(int i, double dt, Vector& force, SpinOf<dim>& torque) {
    auto& contacts = world_.contacts;
    const auto& acting = world_.acting;
    const auto& b = world_.grains.bodies[i];
    for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
      auto& pair = contacts.walls[k];
      typename World::Overlap o;
      Force f;
      if (acting.overlap(world_.grains.shapes, i, b, world_.walls.plane(pair.j), o)) {
        f = acting.force(world_.wall_rule(i, pair.j), b, acting.wall_body(), o, dt, pair.memory);
        force += f.force;
        torque += f.torque_i;
      } else {
        pair.memory = {};
      }
      if constexpr (kind == SweepKind::last) contacts.wall_forces[k] = f;
    }
  }

  World& world_;
  typename World::Integrator integrator_;
  std::vector<Sum> sums_;  // what earlier grains have left for a later one; 0 between steps
  std::atomic<bool> moved_{false};
};

}  // namespace grainfield::dem
