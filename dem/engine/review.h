// Sleeping and waking of grains (loads, ways and speeds as in sleep_settings.h).
//
// Every kReviewEvery steps:
//   wake   a sleeper whose frozen forces, weight and the mean force of its awake neighbours since
//          the last review are out of balance by more than wake_force of its load, and with it
//          along its frozen contacts every sleeper to which what is out of balance passes on more
//          than that of its own load;
//          that an awake neighbour touches at more than wake_speed sqrt(g d); or that lies within
//          wake_reach d v / sqrt(g d) of a grain that comes near sleepers (has one among its
//          candidate pairs) at such a speed v: the grains on which it falls must give way, and what
//          they pass on moves those behind;
//          for a look, when what has been out of balance since it fell asleep would have moved it
//          by kLookWay of its diameter (Sleepers::creep): there it sleeps again only with half of
//          what is out of balance then;
//          A wall that moves wakes what it will touch before the next review.
//   sleep  a grain that has moved by less than quiet_move of its diameter during quiet_time, when
//          it has crept by less than quiet_creep diameters a second since it is quiet and its
//          forces at zero velocity balance to quiet_force of its load.
// A contact between two sleepers, or of a sleeper with a wall at rest, is frozen: it keeps its
// memory and its force at zero velocity until one of them wakes.
//
// The cost follows the grains awake and the sleepers beside them; only the looks, every kLookEvery
// reviews, visit all.
#pragma once
#include <cmath>
#include <utility>
#include <vector>

#include "dem/engine/flatten.h"
#include "dem/engine/search.h"
#include "dem/engine/world.h"

namespace grainfield::dem {

// Sleeping and waking are decided every so many steps.
inline constexpr long kReviewEvery = 50;
// What is left out of balance is added up every so many reviews; ...
inline constexpr long kLookEvery = 20;
// ... a sleeper wakes for a look when it would have moved it by this share of its diameter. Less:
// more looks.
inline constexpr double kLookWay = 0.2;
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
    auto& sleepers = world_.sleepers;
    const double g = length_of(world_.around.gravity);
    bool any = false;
    for (int i = 0; i < world_.awake; ++i) {
      const auto& b = bodies[i];
      const double speed = length_of(b.velocity) + b.radius * size_of(b.spin);
      const double fast = sleep.wake_speed * std::sqrt(g * 2 * b.radius);
      if (g > 0 && speed > fast && has_sleepers_near(i)) {
        const double reach = sleep.wake_reach * speed * std::sqrt(2 * b.radius / g);
        for (const int j : search_.near_sleepers(b.position, b.radius + reach)) any |= wake_up(j);
      }
      for (int k = pairs.first(i); k < pairs.last(i); ++k) {
        const int j = pairs[k].j;
        if (j < world_.awake) continue;
        sleepers.stir(j);
        if (world_.contacts.felt[k].press == 0) continue;
        const double limit = sleep.wake_speed * std::sqrt(g * 2 * bodies[j].radius);
        if (speed > limit) any |= wake_up(j);
      }
    }
    world_.gather_touches();
    const bool driven = world_.walls.any_driven();
    const bool look = world_.steps % (kReviewEvery * kLookEvery) == 0;
    for (int j = world_.awake; j < world_.grains.size(); ++j) {
      if (!sleepers.is_stirred(j) && !driven && !look) continue;
      if (!world_.grains.is_fixed(j)) {
        const double radius = bodies[j].radius;
        const auto residual = sleepers.residual(j, kReviewEvery);
        // Also for nan.
        if (!(residual.unbalanced(radius) <= sleep.wake_force * residual.load)) {
          any |= wake_up(j);
          any |= pass_on(j, residual.force);
        } else if (look && sleepers.is_asleep(j)) {
          const double time = kReviewEvery * kLookEvery * world_.time_step;
          if (sleepers.creep(j, residual, radius, g, time) > kLookWay * 2 * radius) {
            any |= sleepers.wake_for_look(j, residual, radius, world_.steps);
          }
        }
        if (driven && is_reached_by_wall(j)) any |= wake_up(j);
      }
      sleepers.set_judged(j);
    }
    return any;
  }

  bool wake_up(int j) {
    return !world_.grains.is_fixed(j) &&
           world_.sleepers.set_asleep(j, false, world_.grains.bodies[j].position,
                                      world_.rotation(j), world_.steps);
  }

  /// Wakes along the network of frozen contacts: of a force that leaves grain `from` out of balance
  /// each neighbour feels the part along the line of centres. What touches round it, and who of
  /// them shares, is not asked: rather one too many wakes.
  bool pass_on(int from, const typename World::Vector& force) {
    const auto& bodies = world_.grains.bodies;
    const auto& ids = world_.grains.ids;
    bool any = false;
    passed_.assign(1, {from, force});
    while (!passed_.empty()) {
      const auto [i, push] = passed_.back();
      passed_.pop_back();
      for (const int j : search_.near_sleepers(bodies[i].position, bodies[i].radius)) {
        if (j == i || world_.grains.is_fixed(j) || !world_.sleepers.is_asleep(j) ||
            !world_.sleepers.frozen.has(pair_key(ids[i], ids[j]))) {
          continue;
        }
        typename World::Vector line = bodies[j].position - bodies[i].position;
        if (world_.cell.is_periodic()) {
          line += world_.cell.shift(world_.cell.nearest(bodies[i].position, bodies[j].position));
        }
        line.normalize();
        const double part = push.dot(line);
        if (!(part > world_.sleep.wake_force * world_.sleepers.rest(j).load())) continue;
        any |= wake_up(j);
        passed_.push_back({j, part * line});
      }
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

  bool is_marked(int i) const { return i < world_.awake && marked_[i] != 0; }

  /// visit(i, j or wall, is a wall, force, memory) for every contact of the awake in which one of
  /// the marked grains takes part, with the force that it would have at zero velocity.
  template <class Visit>
  GRAINFIELD_FLATTEN void visit_at_rest(Visit visit) {
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
        if (!marked_[i] && !is_marked(pair.j)) continue;
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
      if (!marked_[i]) continue;
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
  bool find_quiet() {
    bool any = false;
    marked_.assign(static_cast<std::size_t>(world_.awake), 0);
    for (int i = 0; i < world_.awake; ++i) {
      const auto& b = world_.grains.bodies[i];
      const auto still = world_.sleepers.stillness(i, b.position, world_.rotation(i), b.radius,
                                                   world_.steps, world_.sleep);
      const double time = static_cast<double>(still.steps) * world_.time_step;
      if (still.steps < 0 || time < world_.sleep.quiet_time ||
          still.way > world_.sleep.quiet_creep * time || b.inverse_mass == 0 ||
          i == world_.applied_index || is_at_driven_wall(i) ||
          (world_.walls.any_driven() && is_reached_by_wall(i))) {
        continue;
      }
      marked_[i] = 1;
      any = true;
    }
    return any;
  }

  static void add(Sum& sum, const ContactForce<dim>& on_it) {
    sum.force += on_it.force;
    sum.torque += on_it.torque_i;
    sum.press += on_it.force.norm();
  }

  bool let_sleep() {
    if (!find_quiet()) return false;
    sums_.assign(static_cast<std::size_t>(world_.awake), Sum{});
    visit_at_rest([&](int i, int j, bool wall, const ContactForce<dim>& f, const Memory&) {
      add(sums_[i], f);
      if (!wall && j < world_.awake) add(sums_[j], seen_from(f, true));
    });
    bool any = false;
    for (int i = 0; i < world_.awake; ++i) {
      if (!marked_[i]) continue;
      auto& b = world_.grains.bodies[i];
      Sum& sum = sums_[i];
      const bool touches = sum.press > 0;
      const typename World::Vector weight = world_.weight(i);
      sum.force += weight;
      sum.press += weight.norm();
      const double unbalanced = sum.force.norm() + size_of(sum.torque) / b.radius;
      if (!(touches &&
            unbalanced <= world_.sleepers.sleeping_share(i, world_.sleep) * sum.load())) {
        marked_[i] = 0;
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
    if (any) freeze();
    return any;
  }

  /// The contacts of those that have just fallen asleep, with others asleep and with walls.
  void freeze() {
    const auto& ids = world_.grains.ids;
    auto& sleepers = world_.sleepers;
    visit_at_rest([&](int i, int j, bool wall, const ContactForce<dim>& f, const Memory& memory) {
      if (!sleepers.is_asleep(i) || (!wall && !sleepers.is_asleep(j))) return;
      sleepers.carry(i, f);
      if (wall) {
        sleepers.frozen.keep({wall_key(ids[i], j), memory, f});
        return;
      }
      sleepers.carry(j, seen_from(f, true));
      const bool other = ids[j] < ids[i];
      sleepers.frozen.keep(
          {pair_key(ids[i], ids[j]), seen_from(memory, other), seen_from(f, other)});
    });
  }

  World& world_;
  const Search<World>& search_;
  // Kept for their memory alone.
  std::vector<unsigned char> marked_;  // of the awake
  std::vector<Sum> sums_;
  std::vector<std::pair<int, typename World::Vector>> passed_;
};

}  // namespace grainfield::dem
