// Sleeping and waking of grains.
//
// Every kReviewEvery steps:
//   wake   a sleeper whose frozen forces, weight and the mean force of its awake neighbours since
//          the last review leave more than wake_force of the forces on it unbalanced; that an
//          awake neighbour touches at more than wake_speed sqrt(g d); or that lies within
//          wake_reach d v / sqrt(g d) of a grain that comes near sleepers (has one among its
//          candidate pairs) at such a speed v: the grains on which it falls must give way, and what
//          they pass on moves those behind;
//          A wall that moves wakes what it will touch before the next review.
//   sleep  a grain that has moved and turned by less than quiet_move of its diameter during
//          quiet_time, when its contacts' forces at zero velocity balance to quiet_force.
// A contact between two sleepers, or of a sleeper with a wall at rest, is frozen: it keeps its
// memory and its force at zero velocity until one of them wakes.
#pragma once
#include <cmath>
#include <vector>

#include "dem/engine/flatten.h"
#include "dem/engine/search.h"
#include "dem/engine/world.h"

namespace grainfield::dem {

// Sleeping and waking are decided every so many steps.
inline constexpr long kReviewEvery = 50;
// A moving wall wakes what it comes near: within this share of a radius, and its way until the next
// review.
inline constexpr double kNearWall = 0.1;

template <class World>
class Review {
 public:
  static constexpr int dim = World::dim;
  using Sum = ForceSum<dim>;
  using Memory = typename World::Memory;

  /// `search` knows the sleepers near a place.
  Review(World& world, const Search<World>& search) : world_(world), search_(search) {}

  /// By one thread, between steps.
  void run() {
    const bool woken = wake();
    if (let_sleep() || woken) world_.search_needed = true;
  }

 private:
  bool wake() {
    const SleepSettings& sleep = world_.sleep;
    const auto& bodies = world_.grains.bodies;
    const auto& pairs = world_.contacts.pairs;
    const double g = length_of(world_.around.gravity);
    bool any = false;
    const auto wake_up = [&](int j) {
      if (!world_.grains.is_fixed(j)) {
        any |= world_.sleepers.set_asleep(j, false, bodies[j].position, world_.rotation(j),
                                          world_.steps);
      }
    };
    for (int i = 0; i < world_.awake; ++i) {
      const auto& b = bodies[i];
      const double speed2 = b.velocity.squaredNorm();
      const double fast = sleep.wake_speed * sleep.wake_speed * g * 2 * b.radius;
      if (g > 0 && speed2 > fast && has_sleepers_near(i)) {
        const double reach = sleep.wake_reach * std::sqrt(speed2 * 2 * b.radius / g);
        for (const int j : search_.near_sleepers(b.position, b.radius + reach)) wake_up(j);
      }
      for (int k = pairs.first(i); k < pairs.last(i); ++k) {
        const int j = pairs[k].j;
        if (j < world_.awake || world_.contacts.felt[k].press == 0) continue;
        const double limit = sleep.wake_speed * sleep.wake_speed * g * 2 * bodies[j].radius;
        if (speed2 > limit) wake_up(j);
      }
    }
    world_.gather_touches();
    const bool driven = world_.walls.any_driven();
    for (int j = world_.awake; j < world_.grains.size(); ++j) {
      if (!world_.grains.is_fixed(j) &&
          world_.sleepers.is_unbalanced(j, bodies[j].radius, kReviewEvery, sleep)) {
        wake_up(j);
      }
      if (driven && is_reached_by_wall(j)) wake_up(j);
      world_.sleepers.forget_touches(j);
    }
    return any;
  }

  /// Near a wall that moves: what it does to a sleeper would go unnoticed.
  bool is_at_driven_wall(int i) const {
    const auto& walls = world_.contacts.walls;
    if (!world_.walls.any_driven()) return false;
    for (int k = walls.first(i); k < walls.last(i); ++k) {
      if (world_.walls.is_driven(world_.walls.wall_of(walls[k].j))) return true;
    }
    return false;
  }
  /// A wall that moves may touch sleeper j before the next review.
  bool is_reached_by_wall(int j) const {
    const auto& b = world_.grains.bodies[j];
    for (int w = 0; w < world_.walls.size(); ++w) {
      if (!world_.walls.is_driven(w)) continue;
      const double way = world_.walls.top_speed(w, b.position) * kReviewEvery * world_.time_step;
      if (world_.walls.is_near(w, b.position, b.radius * (1 + kNearWall) + way)) return true;
    }
    return false;
  }

  bool has_sleepers_near(int i) const {
    const auto& pairs = world_.contacts.pairs;
    for (int k = pairs.first(i); k < pairs.last(i); ++k) {
      if (pairs[k].j >= world_.awake) return true;
    }
    return false;
  }

  /// visit(i, j or wall, is a wall, force, memory) for every contact of the awake in which one of
  /// the marked grains takes part, with the force that it would have at zero velocity.
  template <class Visit>
  GRAINFIELD_FLATTEN void visit_at_rest(const std::vector<unsigned char>& marked, Visit visit) {
    const auto& acting = world_.acting;
    const auto& shapes = world_.grains.shapes;
    auto& contacts = world_.contacts;
    const auto at_rest = [&](int i) {
      typename World::Body b = world_.grains.bodies[i];
      b.velocity.setZero();
      b.spin = zero<SpinOf<dim>>();
      return b;
    };
    typename World::Overlap o;
    for (int i = 0; i < world_.awake; ++i) {
      for (int k = contacts.pairs.first(i); k < contacts.pairs.last(i); ++k) {
        auto& pair = contacts.pairs[k];
        if (!marked[i] && !marked[pair.j]) continue;
        const auto a = at_rest(i);
        auto b = at_rest(pair.j);
        PairImage image{};
        if (world_.cell.is_periodic()) {
          image = contacts.images[k];
          b.position += world_.cell.shift(image);
        }
        if (!world_.overlap(i, a, pair.j, b, image, pair.feature, o)) continue;
        Memory memory = pair.memory;
        const ContactForce<dim> f = acting.force(world_.pair_rule(i, pair.j), a, b, o, 0, memory);
        visit(i, pair.j, false, f, memory);
      }
      if (!marked[i]) continue;
      const auto a = at_rest(i);
      for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
        const int w = contacts.walls[k].j;
        if (!world_.walls.is_plain(w)) {
          visit_wall(world_, i, a, k,
                     [&](int rank, int slot, const auto& overlap, const auto& wall, const auto&) {
                       Memory memory = contacts.walls[slot].memory;
                       const ContactForce<dim> f =
                           acting.force(world_.wall_rule(i, w), a, wall, overlap, 0, memory);
                       visit(i, w + rank, true, f, memory);
                     });
          k += world_.walls.slots_of(world_.walls.wall_of(w)) - 1;
          continue;
        }
        if (!acting.overlap(shapes, i, a, world_.walls.plane(w), o)) continue;
        Memory memory = contacts.walls[k].memory;
        const ContactForce<dim> f =
            acting.force(world_.wall_rule(i, w), a, acting.wall_body(), o, 0, memory);
        visit(i, w, true, f, memory);
      }
    }
  }

  /// Marks the awake that have been quiet for long enough.
  bool find_quiet(std::vector<unsigned char>& marked) {
    bool any = false;
    for (int i = 0; i < world_.awake; ++i) {
      const auto& b = world_.grains.bodies[i];
      const long quiet = world_.sleepers.quiet_steps(i, b.position, world_.rotation(i), b.radius,
                                                     world_.steps, world_.sleep);
      if (quiet < 0 || static_cast<double>(quiet) * world_.time_step < world_.sleep.quiet_time ||
          b.inverse_mass == 0 || i == world_.applied_index || is_at_driven_wall(i) ||
          (world_.walls.any_driven() && is_reached_by_wall(i))) {
        continue;
      }
      marked[i] = 1;
      any = true;
    }
    return any;
  }

  static void add(Sum& sum, const ContactForce<dim>& on_it) {
    sum.force += on_it.force;
    sum.torque += on_it.torque_i;
    sum.press += sum_of_sizes(on_it.force);
  }

  bool let_sleep() {
    std::vector<unsigned char> marked(world_.grains.bodies.size(), 0);
    if (!find_quiet(marked)) return false;
    std::vector<Sum> sums(world_.grains.bodies.size());
    visit_at_rest(marked, [&](int i, int j, bool wall, const ContactForce<dim>& f, const Memory&) {
      add(sums[i], f);
      if (!wall) add(sums[j], seen_from(f, true));
    });
    bool any = false;
    for (int i = 0; i < world_.awake; ++i) {
      if (!marked[i]) continue;
      auto& b = world_.grains.bodies[i];
      const typename World::Vector weight = world_.weight(i), force = sums[i].force + weight;
      const double unbalanced = sum_of_sizes(force) + sum_of_sizes(sums[i].torque) / b.radius;
      if (!(sums[i].press > 0 && unbalanced <= world_.sleep.quiet_force * sums[i].press)) {
        marked[i] = 0;
        continue;
      }
      any = true;
      world_.sleepers.put_to_sleep(i, weight);
      b.velocity.setZero();
      b.spin = zero<SpinOf<dim>>();
      auto& memory = world_.grains.memory[i];
      const auto rotation = memory.rotation;
      memory = {};
      memory.rotation = rotation;
    }
    if (any) freeze(marked);
    return any;
  }

  /// The contacts of those that have just fallen asleep, with others asleep and with walls.
  void freeze(const std::vector<unsigned char>& marked) {
    const auto& ids = world_.grains.ids;
    auto& sleepers = world_.sleepers;
    visit_at_rest(marked,
                  [&](int i, int j, bool wall, const ContactForce<dim>& f, const Memory& memory) {
                    if (!sleepers.is_asleep(i) || (!wall && !sleepers.is_asleep(j))) return;
                    add(sleepers.rest(i), f);
                    if (wall) {
                      sleepers.frozen.keep({wall_key(ids[i], j), memory, f});
                      return;
                    }
                    add(sleepers.rest(j), seen_from(f, true));
                    const bool other = ids[j] < ids[i];
                    sleepers.frozen.keep(
                        {pair_key(ids[i], ids[j]), seen_from(memory, other), seen_from(f, other)});
                  });
  }

  World& world_;
  const Search<World>& search_;
};

}  // namespace grainfield::dem
