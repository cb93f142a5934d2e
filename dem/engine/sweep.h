// One step: forces of the pairs in a fixed order, then the motion of the grains (see engine.h for
// the algorithm).
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dem/engine/contact_forces.h"
#include "dem/engine/flatten.h"
#include "dem/engine/grain_motion.h"
#include "dem/engine/outer_forces.h"
#include "dem/engine/row_forces.h"
#include "dem/engine/rows_of.h"
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
  using Body = typename World::Body;
  /// All pairs are evaluated before any sum, several side by side (batch.h).
  static constexpr bool in_lanes = InLanes<typename World::Shape>;
  /// Rows of pairs are evaluated and summed side by side, several rows at a time (row_forces.h).
  static constexpr bool rows_in_lanes =
      SphereRowsInLanes<typename World::Shape, typename World::Law> ||
      DiskRowsInLanes<typename World::Shape, typename World::Law> ||
      OutlineRowsInLanes<typename World::Shape, typename World::Law>;
  /// So nothing looks at other grains while some begin their next step.
  static constexpr bool begins_in_lanes = (in_lanes || rows_in_lanes) && requires {
    World::Integrator::in_lanes;
  };

  /// Shapes of grains that have begun their next step are placed side by side.
  static constexpr bool places_together =
      requires(typename World::Shape & shapes, const Body* bodies, const double* rotations) {
    shapes.place_all(static_cast<const int*>(nullptr), 0, bodies, rotations, 0);
  };

  explicit Sweep(World& world)
      : world_(world),
        motion_(world),
        balances_(world.balance.on),
        rolls_(world.rolling.on),
        contact_forces_(world),
        outer_forces_(world) {}

  /// After a search: nothing has been added up yet.
  void reset() { sums_.assign(world_.grains.bodies.size(), Sum{}); }

  /// Some grain has left its margin since clear_moved(), or a wall has crossed one.
  bool moved() const { return moved_.load(std::memory_order_relaxed) || contact_forces_.crossed(); }
  void clear_moved() { moved_ = false; }

  /// Before the next step there has to be a search: for a wall that leaves its margin.
  void ask_for_search() { moved_.store(true, std::memory_order_relaxed); }
  /// Some wall goes through a grain by more than half its radius a step.
  bool crossed() const { return contact_forces_.crossed(); }

  /// Begins a step for all grains of a thread's block.
  GRAINFIELD_FLATTEN void begin_block(int rank) {
    bool moved = false;
    const bool flows = world_.cell.flows();
    const Blocks& blocks = world_.contacts.blocks;
    for (int i = blocks.first(rank); i < blocks.last(rank); ++i) {
      if (world_.grains.bodies[i].inverse_mass == 0) continue;
      if (flows) {
        moved |= motion_.begin_in_flow(i);
      } else {
        moved |= motion_.begin(i);
      }
    }
    if (moved) moved_.store(true, std::memory_order_relaxed);
  }

  /// Forces of pairs between two threads' blocks, for a sweep of this kind. They come first in the
  /// sum of their second grain, as they do when one thread sweeps all: run() begins with them.
  template <SweepKind kind>
  GRAINFIELD_FLATTEN void crossing(int rank, double dt) {
    if constexpr (in_lanes) return contact_forces_.evaluate(rank, dt);
    if constexpr (rows_in_lanes && kind == SweepKind::move_on) {
      if (sweeps_rows()) return crossing_rows(rank, dt);
    }
    const bool periodic = world_.cell.is_periodic();
    const PairsInOrder& order = world_.contacts.blocks.crossing(rank);
    for (int n = 0; n < order.count; ++n) {
      const int i = order.first[n], k = order.pair[n];
      Force& f = world_.contacts.pair_forces[k];
      const bool across = periodic && is_image(world_.contacts.images[k]);
      if (!(across ? contact_forces_.pair_across(i, k, dt, f)
                   : contact_forces_.pair(i, k, dt, f))) {
        f = Force{};
      }
    }
  }

  /// The sweep over a block: grain i is complete once its own pairs (i, j > i) are done, because
  /// those with j < i were done at j; so it moves at once and no later pair needs its old place.
  /// `applied`: the applied force. `first_new`: with SweepKind::start, ids from here on are new.
  template <SweepKind kind>
  void run(int rank, const Vector& applied, double dt, std::int64_t first_new = 0) {
    if (world_.added.on()) [[unlikely]]
      begin_with_added(rank);
    sum_incoming(rank, dt);
    if constexpr (rows_in_lanes && kind == SweepKind::move_on) {
      if (sweeps_rows()) {
        if (world_.cell.is_periodic()) {
          sweep_rows<true>(rank, applied, dt);
        } else {
          sweep_rows<false>(rank, applied, dt);
        }
        return;
      }
    }
    if (world_.cell.is_periodic()) {
      sweep<kind, true>(rank, applied, dt, first_new);
    } else {
      sweep<kind, false>(rank, applied, dt, first_new);
    }
  }

 private:
  using Sum = ForceSum<dim>;

  /// The sums of a block begin with the forces of the caller's own.
  [[gnu::noinline]] void begin_with_added(int rank) {
    const Blocks& blocks = world_.contacts.blocks;
    for (int i = blocks.first(rank); i < blocks.last(rank); ++i) {
      const auto& load = world_.added.sum[static_cast<std::size_t>(world_.grains.ids[i])];
      sums_[i].force = load.force;
      sums_[i].torque = load.torque;
    }
  }

  /// Rows are evaluated side by side in this run.
  bool sweeps_rows() const {
    return !balances_ && (dim == 3 || !rolls_) && world_.acting.kinds() == 1 && lane_width() > 2;
  }
  /// Pairs of tails with sleepers or fixed grains, which do not move in this sweep, side by side.
  GRAINFIELD_FLATTEN void asleep_rows(int rank, double dt) {
    const PairsInOrder& order = world_.contacts.blocks.asleep(rank);
    RowForces<World> rows(world_, contact_forces_, sums_, dt, RowForcesGo::to_list);
    for (int n = 0; n < order.count; n += kBatch) {
      const int to = std::min(n + kBatch, order.count);
      for (int m = n; m < to; ++m) world_.contacts.pair_forces[order.pair[m]] = Force{};
      rows.evaluate(order, n, to);
    }
  }
  /// crossing(), side by side but for pairs across a face.
  GRAINFIELD_FLATTEN void crossing_rows(int rank, double dt) {
    auto& contacts = world_.contacts;
    const PairsInOrder& order = contacts.blocks.crossing(rank);
    if (order.count == 0) return;
    const bool periodic = world_.cell.is_periodic();
    RowForces<World> rows(world_, contact_forces_, sums_, dt, RowForcesGo::to_list);
    int from = 0;
    for (int n = 0; n < order.count; ++n) {
      const int k = order.pair[n];
      Force& f = contacts.pair_forces[k];
      f = Force{};
      if (periodic && is_image(contacts.images[k])) {
        rows.evaluate(order, from, n);
        contact_forces_.pair_across(order.first[n], k, dt, f);
        from = n + 1;
      } else if (n + 1 - from == kBatch) {
        rows.evaluate(order, from, n + 1);
        from = n + 1;
      }
    }
    rows.evaluate(order, from, order.count);
  }

  /// Flattened: an overlap, a motion or a force that goes through memory to a function waits for
  /// its stores (a third of the time per step of 1,000 disks). Also begin_block and crossing, so
  /// that all of a step is compiled here, with one order of every sum. `in_cell`: pairs may cross
  /// and space may flow; the loop without knows nothing of it, which is worth 7 % to it.
  template <SweepKind kind, bool in_cell>
  GRAINFIELD_FLATTEN void sweep(int rank, const Vector& applied, double dt,
                                std::int64_t first_new) {
    auto& grains = world_.grains;
    auto& contacts = world_.contacts;
    auto& pairs = contacts.pairs;
    const int first = contacts.blocks.first(rank), last = contacts.blocks.last(rank);
    Begins begins;
    for (int i = first; i < last; ++i) {
      __builtin_prefetch(&grains.memory[i] + kAhead / 2, 1);
      Vector force = sums_[i].force;
      SpinOf<dim> torque = sums_[i].torque;
      sums_[i] = Sum{};
      const int end = in_cell ? first_across(i) : pairs.last(i);
      sum_pairs<kind>(
          pairs.first(i), end, last,
          [&](int k, Force& f) {
            if constexpr (in_lanes) {
              return contact_forces_.evaluated(k, f);
            } else {
              return contact_forces_.pair(i, k, dt, f);
            }
          },
          force, torque);
      if (in_cell && end < pairs.last(i)) {
        const Force across = sum_across<kind>(i, last, dt);
        force += across.force;
        torque += across.torque_i;
      }
      if (grains.bodies[i].inverse_mass == 0) continue;
      end_step<kind, in_cell>(i, force, torque, applied, dt, first_new, begins);
    }
    if constexpr (kind == SweepKind::move_on && begins_in_lanes) {
      begins.moved |= motion_.begin_all(begins.list, begins.waiting);
    }
    if constexpr (kind == SweepKind::move_on && places_together) motion_.place_waiting(begins);
    if (begins.moved) moved_.store(true, std::memory_order_relaxed);
  }

  /// The same, for shapes whose pairs are evaluated and added to the sums kBatch at a time, row
  /// after row (row_forces.h); then the grains whose rows are done move, spheres side by side where
  /// they can. Bit by bit as pair by pair. Pairs that crossing() or asleep_rows() has
  /// evaluated, or whose second grain is across a face, are the last of a row and added by
  /// themselves: before the grain moves, or at once where one is across a face, for it may add to
  /// any grain's sum.
  template <bool in_cell>
  GRAINFIELD_FLATTEN void sweep_rows(int rank, const Vector& applied, double dt) {
    const Blocks& blocks = world_.contacts.blocks;
    const int last = blocks.last(rank);
    if (blocks.first(rank) == last) return;
    asleep_rows(rank, dt);
    const PairsInOrder& order = blocks.inside(rank);
    const std::vector<RowTail>& across = blocks.across(rank);
    RowForces<World> rows(world_, contact_forces_, sums_, dt, RowForcesGo::to_sums);
    Begins begins;
    Ends ends{blocks.first(rank), blocks.tails(rank).data()};
    std::size_t next = 0;  // of the rows with images
    for (int n = 0; n < order.count || next < across.size();) {
      const int stop = next < across.size() ? across[next].before : order.count;
      const int to = std::min(n + kBatch, stop);
      rows.evaluate(order, n, to);
      n = to;
      const int row = n < order.count ? order.first[n] : last;  // the next to be evaluated
      end_rows<in_cell>(next < across.size() ? std::min(row, across[next].row) : row, applied, dt,
                        ends, begins);
      if (!in_cell || n < stop || next == across.size()) continue;
      const RowTail& tail = across[next++];
      add_tail(tail, first_across(tail.row));
      const Force sum = sum_across<SweepKind::move_on>(tail.row, last, dt);
      sums_[tail.row].force += sum.force;
      sums_[tail.row].torque += sum.torque_i;
    }
    end_rows<in_cell>(last, applied, dt, ends, begins);
    if constexpr (begins_in_lanes) begins.moved |= motion_.begin_all(begins.list, begins.waiting);
    if constexpr (places_together) motion_.place_waiting(begins);
    if (begins.moved) moved_.store(true, std::memory_order_relaxed);
  }
  /// What is done of a block, in whose rows pairs go side by side.
  struct Ends {
    int row = 0;                    ///< the first one whose grain has not moved
    const RowTail* tail = nullptr;  ///< the first one that has not been added
  };
  /// A row's pairs from its tail on, up to `end`. What another thread may have written is far away.
  void add_tail(const RowTail& tail, int end) {
    auto& contacts = world_.contacts;
    Sum& sum = sums_[tail.row];
    for (int k = tail.from; k < end; ++k) {
      __builtin_prefetch(&contacts.pair_forces[k + kAhead]);
      const Force& f = contacts.pair_forces[k];
      if (contacts.pairs[k].j >= world_.awake) contacts.felt[k].add_second(f);
      sum.force += f.force;
      sum.torque += f.torque_i;
    }
  }
  /// The motion of rows before `to`, whose sums are complete but for their tails.
  template <bool in_cell>
  void end_rows(int to, const Vector& applied, double dt, Ends& ends, Begins& begins) {
    const auto& bodies = world_.grains.bodies;
    const auto& contacts = world_.contacts;
    const bool together = dim == 3 && world_.all_round && !world_.cell.flows();
    int list[kBatch], count = 0;
    for (int i = ends.row; i < to; ++i) {
      if (ends.tail->row == i) [[unlikely]] {
        add_tail(*ends.tail++, contacts.pairs.last(i));
      }
      if (bodies[i].inverse_mass == 0) {
        sums_[i] = Sum{};
        continue;
      }
      if (together && bodies[i].inverse_inertia > 0) {
        Sum& sum = sums_[i];
        if (contacts.walls.first(i) < contacts.walls.last(i)) {
          contact_forces_.template add_walls<false>(i, dt, sum.force, sum.torque);
        }
        if (world_.is_loaded(i)) [[unlikely]]
          sum.force += applied;
        list[count++] = i;
        if (count < kBatch) continue;
        begins.moved |= step_on(list, count);
        count = 0;
        continue;
      }
      const Vector force = sums_[i].force;
      const SpinOf<dim> torque = sums_[i].torque;
      sums_[i] = Sum{};
      end_step<SweepKind::move_on, in_cell>(i, force, torque, applied, dt, 0, begins);
    }
    begins.moved |= step_on(list, count);
    ends.row = to;
  }
  /// End of a step and beginning of the next of spheres.
  bool step_on(const int* list, int count) {
    if constexpr (dim == 3) {
      if (count == 0) return false;
      const auto& gravity = world_.around.gravity;
      return round_steps({world_.time_step,
                          {gravity[0], gravity[1], gravity[2]},
                          world_.around.drag,
                          world_.local_damping},
                         round_rows_of(world_, sums_), list, count);
    }
    return false;
  }

  /// What else acts on a grain that moves, the end of its step, and the beginning of the next.
  template <SweepKind kind, bool in_cell>
  void end_step(int i, Vector force, SpinOf<dim> torque, const Vector& applied, double dt,
                std::int64_t first_new, Begins& begins) {
    auto& grains = world_.grains;
    auto& b = grains.bodies[i];
    const bool flows = in_cell && world_.cell.flows();
    contact_forces_.template add_walls<kind == SweepKind::last>(i, dt, force, torque);
    if (world_.is_loaded(i)) force += applied;
    typename OuterForces<World>::Damping damping;
    if (outer_forces_.damps()) [[unlikely]] {
      damping = outer_forces_.damping(i, force, torque);
      force += damping.force;
      torque += damping.torque;
    }
    if (balances_ && (kind != SweepKind::start || grains.ids[i] >= first_new)) [[unlikely]] {
      outer_forces_.record(i, world_.is_loaded(i) ? applied : Vector(Vector::Zero()), damping, dt);
    }
    const Load<dim> load{force, torque, world_.around.gravity, world_.around.drag};
    if constexpr (kind == SweepKind::start) {
      if (grains.ids[i] >= first_new) motion_.start(i, load);
    } else {
      if (flows) {
        motion_.end_in_flow(i, load, damping.force);
      } else {
        motion_.end(i, load);
      }
      if constexpr (kind == SweepKind::move_on && begins_in_lanes) {
        begins.list[begins.waiting++] = i;
        if (begins.waiting == kBatch) {
          begins.moved |= motion_.begin_all(begins.list, begins.waiting);
          begins.waiting = 0;
        }
      } else if constexpr (kind == SweepKind::move_on) {
        if (flows) {
          begins.moved |= motion_.begin_in_flow(i);
        } else if constexpr (places_together) {
          begins.moved |= motion_.begin_before_placing(i);
          begins.list[begins.waiting++] = i;
          if (begins.waiting == kBatch) motion_.place_waiting(begins);
        } else {
          begins.moved |= motion_.begin(i);
        }
      } else if constexpr (World::Shape::keeps_places && World::Integrator::end_moves) {
        grains.shapes.place(i, b, grains.memory[i].rotation);
      }
    }
  }

  /// The pairs [first, end), of one row. `last`: the end of the block. evaluate(pair, force): false
  /// when the two do not touch.
  template <SweepKind kind, class Evaluate>
  void sum_pairs(int first, int end, int last, Evaluate evaluate, Vector& force,
                 SpinOf<dim>& torque) {
    auto& contacts = world_.contacts;
    const int* seconds = contacts.seconds.data();
    const int awake = world_.awake;
    for (int k = first; k < end; ++k) {
      const int j = seconds[k];
      const int later = seconds[k + kAhead];
      if constexpr (!in_lanes) __builtin_prefetch(&world_.grains.bodies[later], 1);
      __builtin_prefetch(&sums_[later], 1);
      Force f;
      if (j >= last && j < awake) {
        f = contacts.pair_forces[k];  // crossing() has evaluated it
      } else {
        const bool touches = evaluate(k, f);
        if constexpr (kind == SweepKind::last) contacts.pair_forces[k] = f;
        if (!touches) continue;
        if (j < awake) {
          sums_[j].force -= f.force;
          sums_[j].torque += f.torque_j;
        } else if constexpr (kind != SweepKind::start) {
          // A sleeper, or fixed: it only remembers what it feels.
          contacts.felt[k].add_second(f);
        }
      }
      force += f.force;
      torque += f.torque_i;
    }
  }

  /// The first pair of row i whose second grain is an image; these come last in a row.
  int first_across(int i) const {
    const auto& contacts = world_.contacts;
    int k = contacts.pairs.last(i);
    while (k > contacts.pairs.first(i) && is_image(contacts.images[k - 1])) --k;
    return k;
  }
  /// What those add up to on grain i. Not in line: they are few.
  template <SweepKind kind>
  [[gnu::noinline]] GRAINFIELD_FLATTEN Force sum_across(int i, int last, double dt) {
    Force sum;
    sum_pairs<kind>(
        first_across(i), world_.contacts.pairs.last(i), last,
        [&](int k, Force& f) {
          if constexpr (in_lanes) {
            return contact_forces_.evaluated_across(k, dt, f);
          } else {
            return contact_forces_.pair_across(i, k, dt, f);
          }
        },
        sum.force, sum.torque_i);
    return sum;
  }

  /// Adds forces of pairs from earlier blocks to their second grains.
  GRAINFIELD_FLATTEN void sum_incoming(int rank, double dt) {
    const auto& contacts = world_.contacts;
    const bool periodic = world_.cell.is_periodic();
    const PairsInOrder& order = contacts.blocks.incoming(rank);
    for (int n = 0; n < order.count; ++n) {
      const int k = order.pair[n];
      __builtin_prefetch(&contacts.pair_forces[k + kAhead]);
      Force f = contacts.pair_forces[k];
      if constexpr (in_lanes) {
        const bool across = periodic && is_image(contacts.images[k]);
        if (!(across ? contact_forces_.evaluated_across(k, dt, f)
                     : contact_forces_.evaluated(k, f))) {
          continue;
        }
      }
      Sum& sum = sums_[order.second[n]];
      sum.force -= f.force;
      sum.torque += f.torque_j;
    }
  }

  World& world_;
  GrainMotion<World> motion_;
  const bool balances_;  // there is an energy balance
  const bool rolls_;     // there is resistance against rolling or twisting
  ContactForces<World> contact_forces_;
  OuterForces<World> outer_forces_;
  std::vector<Sum> sums_;  // what earlier grains have left for a later one; 0 between steps
  std::atomic<bool> moved_{false};
};

}  // namespace grainfield::dem
