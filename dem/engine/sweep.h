// One step: forces of the pairs in a fixed order, then the motion of the grains (see engine.h for
// the algorithm).
#pragma once
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dem/engine/batch.h"
#include "dem/engine/flatten.h"
#include "dem/engine/world.h"
#include "dem/motion/load.h"
#include "dem/motion/local_damping.h"
#include "dem/motion/round_lanes.h"

namespace grainfield::dem {

// A grain that moves further than this share of its radius in one step, or a wall that moves so far
// through one, has diverged: a contact would be crossed before it is seen.
inline constexpr double kMaxMoveShare = 0.5;

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
  using Overlap = typename World::Overlap;
  using Rule = typename World::Acting::Rule;
  using Memory = typename World::Acting::Memory;
  /// All pairs are evaluated before any sum, several side by side (batch.h).
  static constexpr bool in_lanes = InLanes<typename World::Shape>;
  /// Rows of pairs are evaluated and summed side by side, several rows at a time (sphere_lanes.h).
  static constexpr bool rows_in_lanes = RowsInLanes<typename World::Shape, typename World::Law>;
  /// So nothing looks at other grains while some begin their next step.
  static constexpr bool begins_in_lanes = (in_lanes || rows_in_lanes) && requires {
    World::Integrator::in_lanes;
  };

  explicit Sweep(World& world)
      : world_(world),
        integrator_(world.time_step),
        books_(world.balance.on),
        rolls_(world.rolling.on),
        aside_(books_ || rolls_),
        local_damping_(world.local_damping) {}

  /// After a search: nothing has been added up yet.
  void reset() { sums_.assign(world_.grains.bodies.size(), Sum{}); }

  /// Some grain has left its margin since clear_moved().
  bool moved() const { return moved_.load(std::memory_order_relaxed); }
  void clear_moved() { moved_ = false; }

  /// Before the next step there has to be a search: for a wall that leaves its margin.
  void ask_for_search() { moved_.store(true, std::memory_order_relaxed); }
  /// Some wall goes through a grain by more than half its radius a step.
  bool crossed() const { return crossed_.load(std::memory_order_relaxed); }

  /// Begins a step for all grains of a thread's block.
  GRAINFIELD_FLATTEN void begin_block(int rank) {
    bool moved = false;
    const bool flows = world_.cell.flows();
    const Blocks& blocks = world_.contacts.blocks;
    for (int i = blocks.first(rank); i < blocks.last(rank); ++i) {
      if (world_.grains.bodies[i].inverse_mass == 0) continue;
      if (flows) {
        moved |= begin_in_flow(i);
      } else {
        begin(i, moved);
      }
    }
    if (moved) moved_.store(true, std::memory_order_relaxed);
  }

  /// Pairs that reach from an earlier thread's block into this one's. They come first in the sum of
  /// their second grain, as they do when one thread sweeps all.
  GRAINFIELD_FLATTEN void incoming(int rank, double dt) {
    if constexpr (in_lanes) return evaluate(rank, dt);
    const bool periodic = world_.cell.is_periodic();
    for (const auto& [i, k] : world_.contacts.blocks.incoming(rank)) {
      Force& f = world_.contacts.pair_forces[k];
      const bool across = periodic && is_image(world_.contacts.images[k]);
      if (!(across ? pair_force_across(i, k, dt, f) : pair_force(i, k, dt, f))) {
        f = Force{};
        continue;
      }
      add_to_second(k, f);
    }
  }

  /// The sweep over a block: grain i is complete once its own pairs (i, j > i) are done, because
  /// those with j < i were done at j; so it moves at once and no later pair needs its old place.
  /// `applied`: the applied force. `first_new`: with SweepKind::start, ids from here on are new.
  template <SweepKind kind>
  void run(int rank, const Vector& applied, double dt, std::int64_t first_new = 0) {
    if constexpr (in_lanes) sum_incoming(rank, dt);
    if constexpr (rows_in_lanes && kind == SweepKind::move_on) {
      if (!books_ && world_.acting.kinds() == 1 && lane_width() > 2) {
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

  /// Grains that begin their next step, together where that is in lanes.
  struct Begins {
    bool moved = false;  ///< one has left its margin
    int waiting = 0, list[kBatch];
  };

  /// Flattened: an overlap, a motion or a force that goes through memory to a function waits for
  /// its stores (a third of the time per step of 1,000 disks). Also begin_block and incoming, so
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
              return evaluated(k, f);
            } else {
              return pair_force(i, k, dt, f);
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
      begins.moved |= begin_all(begins.list, begins.waiting);
    }
    if (begins.moved) moved_.store(true, std::memory_order_relaxed);
  }

  /// The same, for spheres: pairs are evaluated and added to the sums kBatch at a time, row after
  /// row; then the grains whose rows are done move, side by side where they can. Bit by bit as pair
  /// by pair. Pairs that another thread has evaluated, or whose second grain sleeps or is across a
  /// face, are the last of a row and done by themselves.
  template <bool in_cell>
  GRAINFIELD_FLATTEN void sweep_rows(int rank, const Vector& applied, double dt) {
    const auto& contacts = world_.contacts;
    const auto& pairs = contacts.pairs;
    const int first = contacts.blocks.first(rank), last = contacts.blocks.last(rank);
    if (first == last) return;
    const auto& rule = world_.acting.rule(0, 0);
    const SphereNumbers numbers = rule.law.sphere_numbers(rule.friction, dt);
    const auto& r = rule.rolling;
    const RollingNumbers rolling{r.stiffness,          r.damping,          r.friction,
                                 r.twisting_stiffness, r.twisting_damping, r.twisting_friction};
    const SphereRows rows = sphere_rows();
    Begins begins;
    SphereBatch batch;
    int done = first;
    const auto evaluate = [&] {
      if (batch.count > 0) sphere_forces(numbers, rolling, rows, batch);
      batch.count = 0;
    };
    for (int i = first; i < last; ++i) {
      const int end = in_cell ? first_across(i) : pairs.last(i);
      int special = end;
      while (special > pairs.first(i) && pairs[special - 1].j >= last) --special;
      for (int k = pairs.first(i); k < special; ++k) {
        if (batch.count == 0) batch.first = k;
        batch.i[batch.count++] = i;
        if (batch.count < kBatch) continue;
        evaluate();
        end_rows<in_cell>(done, i, applied, dt, begins);
        done = i;
      }
      if (special < pairs.last(i)) {
        evaluate();
        Sum& sum = sums_[i];
        sum_pairs<SweepKind::move_on>(
            special, end, last, [&](int k, Force& f) { return pair_force(i, k, dt, f); }, sum.force,
            sum.torque);
        if (in_cell && end < pairs.last(i)) {
          const Force across = sum_across<SweepKind::move_on>(i, last, dt);
          sum.force += across.force;
          sum.torque += across.torque_i;
        }
      }
    }
    evaluate();
    end_rows<in_cell>(done, last, applied, dt, begins);
    begins.moved |= begin_all(begins.list, begins.waiting);
    if (begins.moved) moved_.store(true, std::memory_order_relaxed);
  }
  SphereRows sphere_rows() {
    using Pair = typename World::Pair;
    constexpr SphereLawKind kind = World::Law::sphere_kind;
    static_assert(sizeof(Body) == kSphereBody * sizeof(double));
    static_assert(sizeof(Sum) == kSphereSum * sizeof(double) && kAhead >= kPairsAhead);
    static_assert(sizeof(RollingMemory<dim>) == 4 * sizeof(double));
    static_assert(sizeof(Pair) == pair_size(kind) && offsetof(Pair, j) == second_in_pair(kind));
    return {world_.grains.bodies.data()->position.data(),
            reinterpret_cast<unsigned char*>(&world_.contacts.pairs[0]), sums_.data()->force.data(),
            rolls_ ? world_.rolling.pairs.data()->roll.data() : nullptr};
  }
  /// The motion of rows [from, to), whose sums are complete.
  template <bool in_cell>
  void end_rows(int from, int to, const Vector& applied, double dt, Begins& begins) {
    const auto& bodies = world_.grains.bodies;
    const auto& contacts = world_.contacts;
    const bool together = world_.all_round && !(local_damping_ > 0) && !world_.cell.flows();
    int list[kBatch], count = 0;
    for (int i = from; i < to; ++i) {
      if (bodies[i].inverse_mass == 0) {
        sums_[i] = Sum{};
        continue;
      }
      if (together && bodies[i].inverse_inertia > 0) {
        Sum& sum = sums_[i];
        if (contacts.walls.first(i) < contacts.walls.last(i)) {
          walls<SweepKind::move_on>(i, dt, sum.force, sum.torque);
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
  }
  /// End of a step and beginning of the next of spheres that nothing else acts on.
  bool step_on(const int* list, int count) {
    if (count == 0) return false;
    auto& grains = world_.grains;
    const auto& gravity = world_.around.gravity;
    using Grip = typename World::Integrator::Memory;
    RoundRows rows;
    rows.bodies = grains.bodies.data()->position.data();
    rows.memories = grains.memory.data()->rotation.coeffs().data();
    rows.sums = sums_.data()->force.data();
    rows.inertias = &grains.inertias.data()->mass;
    rows.margins = world_.margins.data()->position.data();
    rows.body_size = sizeof(Body) / sizeof(double);
    rows.memory_size = sizeof(Grip) / sizeof(double);
    rows.sum_size = sizeof(Sum) / sizeof(double);
    rows.inertia_size = sizeof(Inertia<dim>) / sizeof(double);
    rows.margin_size = sizeof(Margin<dim>) / sizeof(double);
    rows.way = offsetof(Margin<dim>, way) / sizeof(double);
    return round_steps({world_.time_step, {gravity[0], gravity[1], gravity[2]}, world_.around.drag},
                       rows, list, count);
  }

  /// What else acts on a grain that moves, the end of its step, and the beginning of the next.
  template <SweepKind kind, bool in_cell>
  void end_step(int i, Vector force, SpinOf<dim> torque, const Vector& applied, double dt,
                std::int64_t first_new, Begins& begins) {
    auto& grains = world_.grains;
    auto& b = grains.bodies[i];
    const bool flows = in_cell && world_.cell.flows();
    walls<kind>(i, dt, force, torque);
    if (world_.is_loaded(i)) force += applied;
    Damping damping;
    if (local_damping_ > 0) [[unlikely]] {
      damping = damping_of(i, force, torque);
      force += damping.force;
      torque += damping.torque;
    }
    if (books_ && (kind != SweepKind::start || grains.ids[i] >= first_new)) [[unlikely]] {
      record_outer(i, world_.is_loaded(i) ? applied : Vector(Vector::Zero()), damping, dt);
    }
    const Load<dim> load{force, torque, world_.around.gravity, world_.around.drag};
    if constexpr (kind == SweepKind::start) {
      if (grains.ids[i] >= first_new) start(i, load);
    } else {
      if (flows) {
        end_in_flow(i, load, damping.force);
      } else {
        integrator_.end(b, grains.memory[i], grains.inertias[i], load);
      }
      if constexpr (kind == SweepKind::move_on && begins_in_lanes) {
        begins.list[begins.waiting++] = i;
        if (begins.waiting == kBatch) {
          begins.moved |= begin_all(begins.list, begins.waiting);
          begins.waiting = 0;
        }
      } else if constexpr (kind == SweepKind::move_on) {
        if (flows) {
          begins.moved |= begin_in_flow(i);
        } else {
          begin(i, begins.moved);
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
    const auto& pairs = contacts.pairs;
    const int awake = world_.awake;
    for (int k = first; k < end; ++k) {
      const int j = pairs[k].j;
      const int later = pairs[k + kAhead].j;
      __builtin_prefetch(&world_.grains.bodies[later], 1);
      __builtin_prefetch(&sums_[later], 1);
      Force f;
      if (j >= last && j < awake) {
        f = contacts.pair_forces[k];  // the block of j has evaluated it
      } else {
        const bool touches = evaluate(k, f);
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
          felt.press += f.force.norm();
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
            return evaluated_across(k, dt, f);
          } else {
            return pair_force_across(i, k, dt, f);
          }
        },
        sum.force, sum.torque_i);
    return sum;
  }

  void begin(int i, bool& moved) {
    auto& grains = world_.grains;
    auto& b = grains.bodies[i];
    auto& memory = grains.memory[i];
    integrator_.begin(b, memory, grains.inertias[i]);
    moved |= has_left(i);
  }
  /// Of a grain that has moved: its shape is placed, too.
  bool has_left(int i) {
    auto& grains = world_.grains;
    const auto& b = grains.bodies[i];
    const auto& rotation = grains.memory[i].rotation;
    constexpr bool outlines = World::Shape::outlines;
    if constexpr (World::Shape::keeps_places) grains.shapes.place(i, b, rotation);
    return world_.margins[i].template is_left<outlines>(b.position, rotation);
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
  /// begin or begin_in_flow of several grains; true when one may have left its margin.
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
  /// True when the grain may have left its margin.
  [[gnu::noinline]] GRAINFIELD_FLATTEN bool begin_in_flow(int i) {
    auto& grains = world_.grains;
    const auto& cell = world_.cell;
    auto& b = grains.bodies[i];
    b.velocity += cell.kick(b.position);
    integrator_.begin(b, grains.memory[i], grains.inertias[i]);
    return has_left_in_flow(i);
  }

  /// With the drag against the flow, the rest of the acceleration that goes with the flow, and the
  /// flow's work on the grain:
  ///   d/dt (kinetic energy of the fluctuations u + elastic energy)
  ///     = sum over contacts f . G l - sum over grains m u . G u,
  /// written by grains (force F with its weight): -F . G x - m u . G u, and f . G n of the pairs
  /// that cross by edges n (pair_force_across). `local`: what of the load is local damping. It is
  /// against the flow and no part of that.
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
  void start(int i, Load<dim> load) {
    auto& grains = world_.grains;
    auto& b = grains.bodies[i];
    load.gravity += load.drag * world_.cell.flow_at(b.position);
    integrator_.start(b, grains.memory[i], grains.inertias[i], load);
  }

  void add_to_second(int k, const Force& f) {
    Sum& sum = sums_[world_.contacts.pairs[k].j];
    sum.force -= f.force;
    sum.torque += f.torque_j;
  }

  // In lanes: a thread evaluates the pairs of its block's rows but those that reach into a later
  // block, and those that come in from an earlier one. The sums are as without.

  [[gnu::noinline]] GRAINFIELD_FLATTEN void evaluate(int rank, double dt) {
    const auto& contacts = world_.contacts;
    const int last = contacts.blocks.last(rank);
    PairBatches batch(world_, dt, books_, rolls_,
                      [&](const Rule& rule, const Body& a, const Body& b, const Overlap& o,
                          Memory& memory, int k) {
                        return acts(rule, a, b, o, dt, memory, world_.rolling.pairs,
                                    world_.balance.pairs, k)
                            .force;
                      });
    for (const auto& [i, k] : contacts.blocks.incoming(rank)) batch.add(i, k);
    for (int i = contacts.blocks.first(rank); i < last; ++i) {
      for (int k = contacts.pairs.first(i); k < contacts.pairs.last(i); ++k) {
        const int j = contacts.pairs[k].j;
        if (j < last || j >= world_.awake) batch.add(i, k);
      }
    }
    batch.finish();
  }
  GRAINFIELD_FLATTEN void sum_incoming(int rank, double dt) {
    const bool periodic = world_.cell.is_periodic();
    for (const auto& [i, k] : world_.contacts.blocks.incoming(rank)) {
      Force f;
      const bool across = periodic && is_image(world_.contacts.images[k]);
      if (across ? evaluated_across(k, dt, f) : evaluated(k, f)) add_to_second(k, f);
    }
  }
  bool evaluated(int k, Force& f) const {
    f = world_.contacts.pair_forces[k];
    return !f.force.isZero(0);
  }
  bool evaluated_across(int k, double dt, Force& f) {
    if (!evaluated(k, f)) return false;
    if (world_.cell.flows()) {
      world_.grains.cell_work[world_.contacts.pairs[k].j] +=
          dt * f.force.dot(world_.cell.drift(world_.contacts.images[k]));
    }
    return true;
  }

  /// Force of pair k between grain i and its second one; 0 and an empty memory when they do not
  /// touch.
  bool pair_force(int i, int k, double dt, Force& force) {
    if (aside_) [[unlikely]] {
      const Evaluated r = pair_aside(i, k, dt);
      force = r.force;
      return r.touches;
    }
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

  /// The same with an image of the second grain. By the thread that has the second grain's block,
  /// which therefore keeps the flow's work.
  [[gnu::noinline]] GRAINFIELD_FLATTEN bool pair_force_across(int i, int k, double dt,
                                                              Force& force) {
    auto& pair = world_.contacts.pairs[k];
    auto& grains = world_.grains;
    const PairImage image = world_.contacts.images[k];
    const auto& a = grains.bodies[i];
    const typename World::Body b = world_.image_of(grains.bodies[pair.j], image);
    typename World::Overlap o;
    if (!world_.overlap(i, a, pair.j, b, image, pair.feature, o)) {
      pair.memory = {};
      if (rolls_ && dt > 0) world_.rolling.pairs[k] = {};
      if (books_ && dt > 0) world_.balance.pairs[k].add({}, a, b, dt);
      return false;
    }
    const auto& rule = world_.pair_rule(i, pair.j);
    force =
        acts(rule, a, b, o, dt, pair.memory, world_.rolling.pairs, world_.balance.pairs, k).force;
    if (world_.cell.flows()) {
      grains.cell_work[pair.j] += dt * force.force.dot(world_.cell.drift(image));
    }
    return true;
  }

  struct Evaluated {
    Force force;
    bool touches = false;
  };
  // With an energy balance or resistance against rolling the same is done out of line: nothing of
  // it is in the step loop, and nothing that the loop keeps in registers has an address there.
  [[gnu::noinline]] Evaluated pair_aside(int i, int k, double dt) {
    auto& pair = world_.contacts.pairs[k];
    const auto& grains = world_.grains;
    const auto &a = grains.bodies[i], &b = grains.bodies[pair.j];
    typename World::Overlap o;
    if (world_.acting.overlap(grains.shapes, i, a, pair.j, b, pair.feature, o)) {
      const auto& rule = world_.pair_rule(i, pair.j);
      auto& rolling = world_.rolling.pairs;
      return {acts(rule, a, b, o, dt, pair.memory, rolling, world_.balance.pairs, k).force, true};
    }
    pair.memory = {};
    if (rolls_ && dt > 0) world_.rolling.pairs[k] = {};
    if (books_ && dt > 0) world_.balance.pairs[k].add({}, a, b, dt);
    return {};
  }
  /// Force of contact k of a list, with resistance against rolling and its account.
  Acted<dim, Memory> acts(const Rule& rule, const Body& a, const Body& b, const Overlap& o,
                          double dt, Memory& memory, std::vector<RollingMemory<dim>>& rolling,
                          std::vector<Account<dim>>& accounts, int k) const {
    Acted<dim, Memory> out;
    out.before = memory;
    out.force = world_.acting.force(rule, a, b, o, dt, memory);
    if (rolls_) {
      out.rolled = &rolling[k];
      out.moment = roll(rule, a, b, o, dt, rolling[k], out.force);
    }
    if (!books_) return out;
    out.after = memory;
    book<World::Acting::central>(accounts[k], rule, a, b, o, out, dt, [](Force&) {});
    return out;
  }
  /// Moments against rolling and twisting, added to a contact's force; that on the first body.
  SpinOf<dim> roll(const Rule& rule, const Body& a, const Body& b, const Overlap& o, double dt,
                   RollingMemory<dim>& memory, Force& force) const {
    if constexpr (World::Shape::outlines) {
      return zero<SpinOf<dim>>();  // refused by make_engine
    } else {
      return world_.acting.roll(rule, a, b, o, dt, memory, force);
    }
  }

  struct Damping {
    Vector force = zero<Vector>();
    SpinOf<dim> torque = zero<SpinOf<dim>>();
  };
  /// Cundall's, of all other forces on a grain.
  [[gnu::noinline]] Damping damping_of(int i, const Vector force, const SpinOf<dim> torque) const {
    const auto& b = world_.grains.bodies[i];
    return {local_damping(Vector(force + world_.weight(i)), Vector(world_.fluctuation(i)),
                          local_damping_),
            local_damping(torque, b.spin, local_damping_)};
  }

  /// Damping and the applied force on a grain, before its step ends, or (dt = 0) before its first
  /// one begins. `local`: its local damping.
  [[gnu::noinline]] void record_outer(int i, const Vector applied, const Damping& local,
                                      double dt) {
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
    account.work += 0.5 * dt * Vector(account.applied + applied).dot(b.velocity);
    account.drag = drag;
    account.drag_torque = turning;
    account.applied = applied;
  }

  template <SweepKind kind>
  void walls(int i, double dt, Vector& force, SpinOf<dim>& torque) {
    auto& contacts = world_.contacts;
    const auto& acting = world_.acting;
    const auto& b = world_.grains.bodies[i];
    for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
      auto& pair = contacts.walls[k];
      if (aside_ || !world_.walls.is_plain(pair.j)) [[unlikely]] {
        const Sum sum = other_wall(i, k, dt);
        force += sum.force;
        torque += sum.torque;
        k += world_.walls.slots_of(world_.walls.wall_of(pair.j)) - 1;
        continue;
      }
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

  /// Forces of a wall that moves or is no plane (or of any, with an energy balance or resistance
  /// against rolling), whose first slot is pair `first`.
  [[gnu::noinline]] Sum other_wall(int i, int first, double dt) {
    auto& contacts = world_.contacts;
    const auto& b = world_.grains.bodies[i];
    const int slot = contacts.walls[first].j, wall = world_.walls.wall_of(slot);
    const int slots = world_.walls.slots_of(wall);
    const auto& rule = world_.wall_rule(i, slot);
    typename World::Body at_wall = world_.acting.wall_body();
    at_wall.velocity = world_.walls.state(wall).velocity;
    at_wall.spin = world_.walls.state(wall).spin;
    Sum sum;
    unsigned felt = 0;
    std::array<Vector, kMostPatches> normals;
    visit_wall(world_, i, b, first,
               [&](int, int k, const typename World::Overlap& o, const typename World::Body& body,
                   const Vector& normal) {
                 auto& memory = contacts.walls[k].memory;
                 Acted<dim, Memory> acted{{}, memory, {}};
                 Force& f = acted.force;
                 f = world_.acting.force(rule, b, body, o, dt, memory);
                 if (rolls_) {
                   acted.rolled = &world_.rolling.walls[k];
                   acted.moment = roll(rule, b, body, o, dt, world_.rolling.walls[k], f);
                 }
                 const auto about_centre = [&](Force& part) {
                   world_.add_wall_torque(wall, b, o, part);
                 };
                 about_centre(f);
                 if (rolls_) f.torque_j -= acted.moment;
                 sum.force += f.force;
                 sum.torque += f.torque_i;
                 felt |= 1U << (k - first);
                 normals[k - first] = normal;
                 contacts.wall_forces[k] = f;
                 if (std::fabs(body.velocity.dot(normal)) * dt > kMaxMoveShare * b.radius) {
                   crossed_ = moved_ = true;
                 }
                 if (!books_) return;
                 acted.after = memory;
                 book<World::Acting::central>(world_.balance.walls[k], rule, b, at_wall, o, acted,
                                              dt, about_centre);
               });
    for (int s = 0; s < slots; ++s) {
      const int k = first + s;
      const bool touches = (felt >> s & 1U) != 0;
      contacts.wall_normals[k] = touches ? normals[s] : Vector(Vector::Zero());
      if (touches) continue;
      contacts.walls[k].memory = {};
      if (rolls_ && dt > 0) world_.rolling.walls[k] = {};
      contacts.wall_forces[k] = Force{};
      if (books_ && dt > 0) world_.balance.walls[k].add({}, b, at_wall, dt);
    }
    return sum;
  }

  World& world_;
  typename World::Integrator integrator_;
  const bool books_;            // there is an energy balance
  const bool rolls_;            // there is resistance against rolling or twisting
  const bool aside_;            // contacts are evaluated out of line for either
  const double local_damping_;  // Cundall's alpha
  std::vector<Sum> sums_;       // what earlier grains have left for a later one; 0 between steps
  std::atomic<bool> moved_{false}, crossed_{false};
};

}  // namespace grainfield::dem
