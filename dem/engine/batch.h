// Pairs evaluated several side by side: the overlaps by the shape's kernel, the forces by the law's
// where it has one. Bit by bit what pair by pair comes out; the forces go to the list of contacts,
// 0 of pairs that do not touch.
#pragma once
#include "dem/engine/world.h"
#include "dem/laws/contact_batch.h"

namespace grainfield::dem {

/// A shape with overlaps side by side (shape.h).
template <class Shape>
concept InLanes = requires {
  typename Shape::Batch;
};
/// A law with forces side by side (law.h).
template <class Law>
concept LawInLanes = requires(const Law& law, const OverlapBatch& overlaps,
                              ContactBatch& contacts) {
  law.lanes(overlaps, 0.0, 0.0, contacts, 0);
};

/// `Act`: act(rule, a, b, overlap, memory, k) is the force of pair k alone, with its account.
template <class World, class Act>
class PairBatches {
 public:
  using Force = ContactForce<World::dim>;
  using Body = typename World::Body;
  using Overlap = typename World::Overlap;
  using Shape = typename World::Shape;

  /// For a step of dt, s. `balances`, `rolls`: there is an energy balance, resistance against
  /// rolling.
  PairBatches(World& world, double dt, bool balances, bool rolls, Act act)
      : world_(world),
        dt_(dt),
        balances_(balances),
        rolls_(rolls),
        law_in_lanes_(takes_law()),
        act_(act) {}

  /// Pair k, of grains i and j. Returns until when it may be left out (contact_list.h).
  double add(int i, int j, int k) {
    auto& feature = world_.contacts.pairs[k].feature;
    const auto& bodies = world_.grains.bodies;
    const auto& shapes = world_.grains.shapes;
    typename World::Vector at = bodies[j].position;
    const bool across = is_across(k);
    if (across) at += world_.cell.shift(world_.contacts.images[k]);
    if (!shapes.template put<World::Law::measures>(batch_, i, bodies[i], j, at, feature)) {
      apart(i, k);
      const bool stays = dt_ > 0 && !balances_ && !rolls_ && !(across && world_.cell.flows());
      return stays ? shapes.apart_until(i, bodies[i], j, at, feature) : 0;
    }
    const int slot = batch_.count - 1;
    first_[slot] = i;
    pair_[slot] = k;
    if (law_in_lanes_) take_motion(slot, bodies[i], bodies[j], across);
    if (batch_.count == kBatch) finish();
    return 0;
  }
  /// All that is left.
  void finish() {
    if (batch_.count == 0) return;
    world_.grains.shapes.template finish<World::Law::measures>(batch_);
    if constexpr (LawInLanes<typename World::Law>) {
      if (law_in_lanes_) {
        const auto& rule = world_.acting.rule(0, 0);
        rule.law.lanes(batch_.overlaps, rule.friction, dt_, contacts_, batch_.count);
      }
    }
    for (int slot = 0; slot < batch_.count; ++slot) {
      if (!batch_.touches[slot]) {
        apart(first_[slot], pair_[slot]);
      } else if (law_in_lanes_ && contacts_.left[slot] == 0) {
        scatter(slot);
      } else {
        act_alone(first_[slot], pair_[slot], Shape::overlap_of(batch_, slot));
      }
    }
    batch_.count = 0;
  }

 private:
  /// One rule for all pairs, and nothing that asks for a contact's own account.
  bool takes_law() const {
    if constexpr (LawInLanes<typename World::Law>) {
      return dt_ > 0 && !balances_ && !rolls_ && world_.acting.kinds() == 1 &&
             world_.acting.rule(0, 0).law.has_lanes();
    }
    return false;
  }
  bool is_across(int k) const {
    return world_.cell.is_periodic() && is_image(world_.contacts.images[k]);
  }

  void take_motion(int slot, const Body& a, const Body& b, bool across) {
    const auto put = [slot](const typename World::Vector& from, double(&to)[3][kBatch]) {
      for (int d = 0; d < 3; ++d) to[d][slot] = from[d];
    };
    typename World::Vector other = b.velocity;
    if (across) other += world_.cell.drift(world_.contacts.images[pair_[slot]]);
    put(a.velocity - other, contacts_.velocity);
    put(a.spin, contacts_.spin_i);
    put(b.spin, contacts_.spin_j);
    contacts_.inverse_mass[slot] = a.inverse_mass + b.inverse_mass;
    const auto& memory = world_.contacts.pairs[pair_[slot]].memory;
    put(memory.spring, contacts_.spring);
    if constexpr (LawInLanes<typename World::Law>) {
      contacts_.contact_radius[slot] = memory.contact_radius;
    }
  }
  void scatter(int slot) {
    const auto vector = [slot](const double(&v)[3][kBatch]) {
      return typename World::Vector(v[0][slot], v[1][slot], v[2][slot]);
    };
    const int k = pair_[slot];
    world_.contacts.pair_forces[k] = {vector(contacts_.force), vector(contacts_.torque_i),
                                      vector(contacts_.torque_j)};
    auto& memory = world_.contacts.pairs[k].memory;
    memory.spring = vector(contacts_.spring);
    if constexpr (LawInLanes<typename World::Law>) {
      memory.contact_radius = contacts_.contact_radius[slot];
    }
  }

  [[gnu::noinline]] void act_alone(int i, int k, const Overlap& o) {
    auto& pair = world_.contacts.pairs[k];
    world_.contacts.pair_forces[k] =
        act_(world_.pair_rule(i, pair.j), world_.grains.bodies[i], second(k), o, pair.memory, k);
  }
  void apart(int i, int k) {
    auto& contacts = world_.contacts;
    contacts.pairs[k].memory = {};
    if (!contacts.pair_forces[k].force.isZero(0)) contacts.pair_forces[k] = Force{};
    if (dt_ > 0 && (balances_ || rolls_)) [[unlikely]]
      account_apart(i, k);
  }
  [[gnu::noinline]] void account_apart(int i, int k) {
    if (rolls_) world_.rolling.pairs[k] = {};
    if (balances_) world_.balance.pairs[k].add({}, world_.grains.bodies[i], second(k), dt_);
  }
  Body second(int k) const {
    const Body& b = world_.grains.bodies[world_.contacts.pairs[k].j];
    return is_across(k) ? world_.image_of(b, world_.contacts.images[k]) : b;
  }

  World& world_;
  const double dt_;
  const bool balances_, rolls_, law_in_lanes_;
  Act act_;
  typename Shape::Batch batch_;
  ContactBatch contacts_{};
  int first_[kBatch], pair_[kBatch];
};

}  // namespace grainfield::dem
