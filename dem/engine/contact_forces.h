// Forces of single contacts, of pairs and of grains at walls: overlap, law and its memory,
// resistance against rolling, the energy account. What adds them up is in sweep.h.
#pragma once
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "dem/engine/batch.h"
#include "dem/engine/flatten.h"
#include "dem/engine/world.h"

namespace grainfield::dem {

// A grain that moves further than this share of its radius in one step, or a wall that moves so far
// through one, has diverged: a contact would be crossed before it is seen.
inline constexpr double kMaxMoveShare = 0.5;

template <class World>
class ContactForces {
 public:
  static constexpr int dim = World::dim;
  using Force = ContactForce<dim>;
  using Sum = ForceSum<dim>;
  using Vector = typename World::Vector;
  using Body = typename World::Body;
  using Overlap = typename World::Overlap;
  using Rule = typename World::Acting::Rule;
  using Memory = typename World::Acting::Memory;

  explicit ContactForces(World& world)
      : world_(world),
        balances_(world.balance.on),
        rolls_(world.rolling.on),
        out_of_line_(balances_ || rolls_) {}

  /// Some wall goes through a grain by more than half its radius a step.
  bool crossed() const { return crossed_.load(std::memory_order_relaxed); }

  /// Force of pair k between grain i and its second one; 0 and an empty memory when they do not
  /// touch.
  bool pair(int i, int k, double dt, Force& force) {
    if (out_of_line_) [[unlikely]] {
      const Evaluated r = pair_out_of_line(i, k, dt);
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
  [[gnu::noinline]] GRAINFIELD_FLATTEN bool pair_across(int i, int k, double dt, Force& force) {
    auto& pair = world_.contacts.pairs[k];
    auto& grains = world_.grains;
    const PairImage image = world_.contacts.images[k];
    const auto& a = grains.bodies[i];
    const typename World::Body b = world_.image_of(grains.bodies[pair.j], image);
    typename World::Overlap o;
    if (!world_.overlap(i, a, pair.j, b, image, pair.feature, o)) {
      pair.memory = {};
      if (rolls_ && dt > 0) world_.rolling.pairs[k] = {};
      if (balances_ && dt > 0) world_.balance.pairs[k].add({}, a, b, dt);
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

  /// In lanes: a thread evaluates the pairs within its block, and its share of those between two.
  [[gnu::noinline]] GRAINFIELD_FLATTEN void evaluate(int rank, double dt) {
    PairBatches batch(world_, dt, balances_, rolls_,
                      [&](const Rule& rule, const Body& a, const Body& b, const Overlap& o,
                          Memory& memory, int k) {
                        return acts(rule, a, b, o, dt, memory, world_.rolling.pairs,
                                    world_.balance.pairs, k)
                            .force;
                      });
    const double* ways = world_.grains.shapes.ways();
    for (PairToEvaluate& pair : world_.contacts.to_evaluate[static_cast<std::size_t>(rank)]) {
      if (ways[pair.i] + ways[pair.j] < pair.until) continue;
      pair.until = batch.add(pair.i, pair.j, pair.k);
    }
    batch.finish();
  }
  /// What evaluate() has found; false when the two do not touch.
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

  /// Adds the forces of all walls on grain i. `keep`: for measure() and snapshot(), too.
  template <bool keep>
  void add_walls(int i, double dt, Vector& force, SpinOf<dim>& torque) {
    auto& contacts = world_.contacts;
    const auto& acting = world_.acting;
    const auto& b = world_.grains.bodies[i];
    for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
      auto& pair = contacts.walls[k];
      if (out_of_line_ || !world_.walls.is_plain(pair.j)) [[unlikely]] {
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
      if constexpr (keep) contacts.wall_forces[k] = f;
    }
  }

 private:
  struct Evaluated {
    Force force;
    bool touches = false;
  };
  // With an energy balance or resistance against rolling the same is done out of line: nothing of
  // it is in the step loop, and nothing that the loop keeps in registers has an address there.
  [[gnu::noinline]] Evaluated pair_out_of_line(int i, int k, double dt) {
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
    if (balances_ && dt > 0) world_.balance.pairs[k].add({}, a, b, dt);
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
    if (!balances_) return out;
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
                   crossed_.store(true, std::memory_order_relaxed);
                 }
                 if (!balances_) return;
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
      if (balances_ && dt > 0) world_.balance.walls[k].add({}, b, at_wall, dt);
    }
    return sum;
  }

  World& world_;
  const bool balances_;     // there is an energy balance
  const bool rolls_;        // there is resistance against rolling or twisting
  const bool out_of_line_;  // contacts are evaluated out of line for either
  std::atomic<bool> crossed_{false};
};

}  // namespace grainfield::dem
