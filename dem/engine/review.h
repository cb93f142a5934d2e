// Sleeping and waking of grains (loads, ways and speeds as in sleep_settings.h).
//
// Every kReviewEvery steps:
//   wake   a sleeper whose frozen forces, weight and the mean force of its awake neighbours are out
//          of balance by more than wake_force of its load in the mean over wake_time, or by more
//          than wake_shock since the last review, and with it along its frozen contacts every
//          sleeper to which what is out of balance passes on more than wake_force of its own load.
//          An elastic wave shakes a sleeper for a millisecond by more than wake_force and leaves
//          nothing behind; a load that has changed stays;
//          that an awake neighbour touches at more than wake_speed sqrt(g d); or that lies within
//          wake_reach d v / sqrt(g d) of a grain that comes near sleepers (has one among its
//          candidate pairs) at such a speed v: the grains on which it falls must give way, and what
//          they pass on moves those behind;
//          for a look, when what has been out of balance since it fell asleep would have moved it
//          by kLookWay of its diameter (Sleepers::creep): there it sleeps again only with half of
//          what is out of balance then;
//          with all others, when at a look the force that a level passes on differs from the weight
//          above it by more than wake_levels of that: residuals too small to wake a grain add up
//          over the levels of a large packing. What then stays in place is awake for wake_time. Not
//          in periodic cells.
//          A wall that moves wakes what it will touch before the next review.
//   sleep  a grain that has moved by less than quiet_move of its diameter during quiet_time against
//          what it touches, when it has crept there by less than quiet_creep diameters a second,
//          its forces at zero velocity balance to quiet_force of its load, and it moves with no
//          more energy than the force that may be hidden so does on the way that may be. What a
//          grain touches carries it: the place where it is still goes along with the mean of the
//          rigid motions of its neighbours. So a common swing of the pile, which hardly strains a
//          contact, keeps nobody awake while it unbalances nobody.
// A contact between two sleepers, or of a sleeper with a wall at rest, is frozen: it keeps its
// memory and its force at zero velocity until one of them wakes.
//
// The cost follows the grains awake and the sleepers beside them; only the looks, every kLookEvery
// reviews, visit all.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dem/engine/flatten.h"
#include "dem/engine/report.h"
#include "dem/engine/search.h"
#include "dem/engine/world.h"
#include "dem/sleep/hidden_load.h"

namespace grainfield::dem {

// Sleeping and waking are decided every so many steps.
inline constexpr long kReviewEvery = 50;
// What is left out of balance is added up every so many reviews; ...
inline constexpr long kLookEvery = 20;
// ... a sleeper wakes for a look when it would have moved it by this share of its diameter. Less:
// more looks, and what stays out of balance is passed on sooner (a fiftieth of the load after 50 ms
// with diameters of 5 mm).
inline constexpr double kLookWay = 0.05;
// The mean of what is out of balance no longer changes where it is within this share of wake_force
// of what it is now.
inline constexpr double kSettledMean = 0.1;
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
        if (world_.contacts.felt[k].force_sum == 0) continue;
        const double limit = sleep.wake_speed * std::sqrt(g * 2 * bodies[j].radius);
        if (speed > limit) any |= wake_up(j);
      }
    }
    world_.gather_touches();
    const bool driven = world_.walls.any_driven();
    const bool look = world_.steps % (kReviewEvery * kLookEvery) == 0;
    if (look) unbalanced_.assign(world_.grains.bodies.size(), zero<typename World::Vector>());
    const double weight = std::min(1.0, kReviewEvery * world_.time_step / sleep.wake_time);
    for (int j = world_.awake; j < world_.grains.size(); ++j) {
      if (!sleepers.is_stirred(j) && !driven && !look) continue;
      bool settled = true;
      if (!world_.grains.is_fixed(j)) {
        const double radius = bodies[j].radius;
        const auto now = sleepers.residual(j, kReviewEvery);
        const auto& mean = sleepers.add_to_mean(j, now, weight);
        // Also for nan.
        const bool shock = !(now.unbalanced(radius) <= sleep.wake_shock * now.load);
        if (shock || !(mean.unbalanced(radius) <= sleep.wake_force * mean.load)) {
          any |= wake_up(j);
          any |= pass_on(j, shock ? now.force : mean.force);
        } else if (look && sleepers.is_asleep(j)) {
          const double time = kReviewEvery * kLookEvery * world_.time_step;
          if (sleepers.creep(j, mean, radius, g, time) > kLookWay * 2 * radius) {
            any |= sleepers.wake_for_look(j, mean, radius, world_.steps);
          }
        }
        if (driven && is_reached_by_wall(j)) any |= wake_up(j);
        settled = (now.force - mean.force).norm() <= kSettledMean * sleep.wake_force * now.load;
        if (look) unbalanced_[j] = settled ? now.force : mean.force;
      }
      sleepers.set_judged(j, settled);
    }
    return (look && wake_levels()) || any;
  }

  /// Wakes all, where the sleepers hide more than wake_levels of the weight above some level. They
  /// count as quiet only from wake_time later on.
  bool wake_levels() {
    const auto& gravity = world_.around.gravity;
    const double g = length_of(gravity);
    if (!(g > 0) || world_.cell.is_periodic()) return false;
    shares_.clear();
    for (int i = 0; i < world_.grains.size(); ++i) {
      if (world_.grains.is_fixed(i)) continue;
      const bool asleep = i >= world_.awake && world_.sleepers.is_asleep(i);
      shares_.push_back({-world_.grains.bodies[i].position.dot(gravity) / g,
                         world_.weight(i).norm(), asleep ? unbalanced_[i].dot(gravity) / g : 0.0});
    }
    if (!(largest_hidden_share(shares_) > world_.sleep.wake_levels)) return false;
    const long until = world_.steps + std::lround(world_.sleep.wake_time / world_.time_step);
    bool any = false;
    for (int j = world_.awake; j < world_.grains.size(); ++j) any |= wake_up(j, until);
    return any;
  }

  bool wake_up(int j) { return wake_up(j, world_.steps); }
  /// It is taken to be quiet since step `since`, also a later one.
  bool wake_up(int j, long since) {
    return !world_.grains.is_fixed(j) &&
           world_.sleepers.set_asleep(j, false, world_.grains.bodies[j].position,
                                      world_.rotation(j), since);
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

  /// A contact as it would be at zero velocity. `j`: of a wall a slot; k: in its list.
  struct AtRest {
    int i = 0, j = 0, k = 0;
    bool wall = false;
    Memory memory{};
    RollingMemory<dim> rolled{};
    SpinOf<dim> moment = zero<SpinOf<dim>>();  // of rolling and twisting
    ContactForce<dim> force{};
  };
  template <class Rule>
  void act(const Rule& rule, const typename World::Body& a, const typename World::Body& b,
           const typename World::Overlap& o, AtRest& c) const {
    c.force = world_.acting.force(rule, a, b, o, 0, c.memory);
    if constexpr (!World::Shape::outlines) {
      if (!world_.rolling.on) return;
      c.rolled = c.wall ? world_.rolling.walls[c.k] : world_.rolling.pairs[c.k];
      c.moment = world_.acting.roll(rule, a, b, o, 0, c.rolled, c.force);
    }
  }

  /// visit(contact, overlap, rule) for every contact of the awake in which one of the marked grains
  /// takes part, and apart(contact) where the two do not touch.
  template <class Visit, class Apart>
  GRAINFIELD_FLATTEN void visit_at_rest(Visit visit, Apart apart) {
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
        AtRest c{i, pair.j, k, false, pair.memory};
        if (!world_.overlap(i, a, pair.j, b, image, pair.feature, o)) {
          apart(c);
          continue;
        }
        const auto& rule = world_.pair_rule(i, pair.j);
        act(rule, a, b, o, c);
        visit(c, o, rule);
      }
      if (!marked_[i]) continue;
      const auto a = at_rest(i);
      for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
        const int w = contacts.walls[k].j;
        const auto& rule = world_.wall_rule(i, w);
        if (!world_.walls.is_plain(w)) {
          unsigned felt = 0;
          visit_wall(world_, i, a, k,
                     [&](int rank, int slot, const auto& overlap, const auto& wall, const auto&) {
                       felt |= 1U << (slot - k);
                       AtRest c{i, w + rank, slot, true, contacts.walls[slot].memory};
                       act(rule, a, wall, overlap, c);
                       visit(c, overlap, rule);
                     });
          const int slots = world_.walls.slots_of(world_.walls.wall_of(w));
          for (int s = 0; s < slots; ++s) {
            if ((felt >> s & 1U) == 0) apart(AtRest{i, w + s, k + s, true});
          }
          k += slots - 1;
          continue;
        }
        AtRest c{i, w, k, true, contacts.walls[k].memory};
        if (!acting.overlap(shapes, i, a, world_.walls.plane(w), o)) {
          apart(c);
          continue;
        }
        act(rule, a, acting.wall_body(), o, c);
        visit(c, o, rule);
      }
    }
  }

  /// Every awake grain's place goes along with what it touches: by the mean of the rigid motions
  /// of its neighbours since the last review, where walls and sleepers do not move.
  GRAINFIELD_FLATTEN void carry_places() {
    using Step = typename World::Sleepers::Step;
    const int n = world_.awake;
    const auto& bodies = world_.grains.bodies;
    const auto& contacts = world_.contacts;
    steps_.resize(static_cast<std::size_t>(n));
    carried_.assign(static_cast<std::size_t>(n), {});
    for (int i = 0; i < n; ++i) {
      steps_[i] = world_.sleepers.since_review(i, bodies[i].position, world_.rotation(i));
    }
    const auto carry = [&](int i, const Step& by, const typename World::Vector& arm) {
      auto& c = carried_[i];
      c.step.way += by.way + velocity_at(by.turn, arm);
      c.step.turn += by.turn;
      ++c.touched;
    };
    for (int i = 0; i < n; ++i) {
      for (int k = contacts.pairs.first(i); k < contacts.pairs.last(i); ++k) {
        const int j = contacts.pairs[k].j;
        if (!touch(i, k)) continue;
        typename World::Vector arm = bodies[j].position - bodies[i].position;
        if (world_.cell.is_periodic()) arm += world_.cell.shift(contacts.images[k]);
        carry(i, j < n ? steps_[j] : Step{}, -arm);
        if (j < n) carry(j, steps_[i], arm);
      }
      for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
        if (!contacts.walls[k].memory.empty()) ++carried_[i].touched;
      }
    }
    for (int i = 0; i < n; ++i) {
      auto& c = carried_[i];
      if (c.touched > 0) {
        c.step.way /= c.touched;
        c.step.turn /= c.touched;
      }
      world_.sleepers.carry_place(i, c.step, bodies[i].position, world_.rotation(i));
    }
  }
  /// The grains of pair k of row i touch.
  bool touch(int i, int k) const {
    const auto& pair = world_.contacts.pairs[k];
    if (!pair.memory.empty()) return true;
    const auto& bodies = world_.grains.bodies;
    const auto image = world_.cell.is_periodic() ? world_.contacts.images[k] : PairImage{};
    auto feature = pair.feature;
    typename World::Overlap o;
    return world_.overlap(i, bodies[i], pair.j, world_.image_of(bodies[pair.j], image), image,
                          feature, o);
  }

  /// Marks the awake that have been quiet for long enough.
  bool find_quiet() {
    bool any = false;
    carry_places();
    marked_.assign(static_cast<std::size_t>(world_.awake), 0);
    for (int i = 0; i < world_.awake; ++i) {
      const auto& b = world_.grains.bodies[i];
      const auto still = world_.sleepers.stillness(i, b.position, world_.rotation(i), b.radius,
                                                   world_.steps, world_.sleep);
      const double time = static_cast<double>(still.steps) * world_.time_step;
      if (still.steps < 0 || time < world_.sleep.quiet_time ||
          still.way > world_.sleep.quiet_creep * time || b.inverse_mass == 0 ||
          world_.is_loaded(i) || is_at_driven_wall(i) ||
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
    sum.force_sum += on_it.force.norm();
  }

  bool let_sleep() {
    if (!find_quiet()) return false;
    sums_.assign(static_cast<std::size_t>(world_.awake), Sum{});
    visit_at_rest(
        [&](const AtRest& c, const auto&, const auto&) {
          add(sums_[c.i], c.force);
          if (!c.wall && c.j < world_.awake) add(sums_[c.j], seen_from(c.force, true));
        },
        [](const AtRest&) {});
    bool any = false;
    const auto& ids = world_.grains.ids;
    if (world_.balance.on) moved_.assign(static_cast<std::size_t>(world_.awake), {});
    for (int i = 0; i < world_.awake; ++i) {
      if (!marked_[i]) continue;
      auto& b = world_.grains.bodies[i];
      Sum& sum = sums_[i];
      const bool touches = sum.force_sum > 0;
      const typename World::Vector weight = world_.weight(i);
      sum.force += weight;
      sum.force_sum += weight.norm();
      const double unbalanced = sum.force.norm() + size_of(sum.torque) / b.radius;
      const double energy = Report(world_).kinetic_energy(i);
      if (!(touches && unbalanced <= world_.sleepers.sleeping_share(i, world_.sleep) * sum.load() &&
            energy <= world_.sleepers.most_energy(sum.load(), b.radius, world_.sleep))) {
        marked_[i] = 0;
        continue;
      }
      any = true;
      if (world_.balance.on) {
        moved_[i] = {b.velocity, b.spin};
        // With what the forces would have done until the end of this step.
        const double rest =
            0.5 * world_.time_step * (sum.force.dot(b.velocity) + power_of(sum.torque, b.spin));
        world_.balance.stop(energy + rest, ids[i]);
      }
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

  /// The contacts of those that have just fallen asleep, with others asleep and with walls. What
  /// they remember beside the law, and their accounts, stay in the lists until the search.
  void freeze() {
    const auto& ids = world_.grains.ids;
    auto& sleepers = world_.sleepers;
    const auto rest = [&](const AtRest& c) {
      return sleepers.is_asleep(c.i) && (c.wall || sleepers.is_asleep(c.j));
    };
    visit_at_rest(
        [&](const AtRest& c, const auto& o, const auto& rule) {
          if (world_.balance.on) close(c, rest(c), parts_at_rest(c, o, rule));
          if (!rest(c)) return;
          if (world_.rolling.on) rolling_of(c) = c.rolled;
          sleepers.carry(c.i, c.force);
          if (c.wall) {
            sleepers.frozen.keep({wall_key(ids[c.i], c.j), c.memory, c.force});
            if (world_.contacts.walls[c.k].j != c.j) move_to_rank(c);
            return;
          }
          sleepers.carry(c.j, seen_from(c.force, true));
          const bool other = ids[c.j] < ids[c.i];
          sleepers.frozen.keep({pair_key(ids[c.i], ids[c.j]), seen_from(c.memory, other),
                                seen_from(c.force, other)});
        },
        [&](const AtRest& c) {
          if (world_.balance.on) close(c, rest(c), {});
          if (world_.rolling.on && rest(c)) rolling_of(c) = {};
        });
  }
  RollingMemory<dim>& rolling_of(const AtRest& c) {
    return (c.wall ? world_.rolling.walls : world_.rolling.pairs)[c.k];
  }
  Account<dim>& account_of(const AtRest& c) {
    return (c.wall ? world_.balance.walls : world_.balance.pairs)[c.k];
  }

  /// A frozen contact with a wall of several is found again by its rank, not by the slot in which
  /// it was listed: so what stays in the lists leaves that slot.
  void move_to_rank(const AtRest& c) {
    const PairKey key = wall_key(world_.grains.ids[c.i], c.j);
    if (world_.rolling.on) {
      world_.rolling.told.push_back({key, c.rolled});
      rolling_of(c) = {};
    }
    if (!world_.balance.on) return;
    Account<dim>& account = account_of(c);
    world_.balance.gone += account.gone;
    account.gone = {};
    world_.balance.frozen.push_back({key, account});
    account = {};
  }

  template <class Rule>
  ContactParts<dim> parts_at_rest(const AtRest& c, const typename World::Overlap& o,
                                  const Rule& rule) const {
    const auto& pair = c.wall ? world_.contacts.walls[c.k] : world_.contacts.pairs[c.k];
    Acted<dim, Memory> acted{c.force, pair.memory, c.memory, c.moment};
    if (world_.rolling.on) acted.rolled = &c.rolled;
    return parts_of<World::Acting::central>(rule, o, acted, [](ContactForce<dim>&) {});
  }
  /// Into the account of a contact: the step in which those that stop have moved last. `rest`: with
  /// what they touch there, and the step is over; else the sweep ends it for the other one.
  void close(const AtRest& c, bool rest, const ContactParts<dim>& now) {
    const auto moved = [&](int i) {
      typename World::Body b = world_.grains.bodies[i];
      if (i < world_.awake) {
        b.velocity = moved_[i].velocity;
        b.spin = moved_[i].spin;
      }
      return b;
    };
    const auto a = moved(c.i), b = c.wall ? world_.acting.wall_body() : moved(c.j);
    if (rest) {
      account_of(c).add(now, a, b, world_.time_step);
    } else {
      account_of(c).stop(now, a, b, world_.time_step);
    }
  }

  World& world_;
  const Search<World>& search_;
  // Kept for their memory alone.
  std::vector<unsigned char> marked_;  // of the awake
  std::vector<Sum> sums_;
  struct Carried {
    typename World::Sleepers::Step step;
    int touched = 0;
  };
  std::vector<typename World::Sleepers::Step> steps_;  // of the awake, since the last review
  std::vector<Carried> carried_;                       // by what they touch
  struct Moved {
    typename World::Vector velocity = zero<typename World::Vector>();
    SpinOf<dim> spin = zero<SpinOf<dim>>();
  };
  std::vector<Moved> moved_;  // of those that fall asleep, with an energy balance
  std::vector<std::pair<int, typename World::Vector>> passed_;
  std::vector<typename World::Vector> unbalanced_;  // at a look, of sleepers
  std::vector<LevelShare> shares_;
};

}  // namespace grainfield::dem
