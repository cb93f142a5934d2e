// Pairs evaluated several side by side: the overlaps by the shape's kernel, the forces by the law's
// where it has one. Bit by bit what pair by pair comes out; the forces go to the list of contacts,
// 0 of pairs that do not touch.
#pragma once
#include <cstddef>

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
    if (law_in_lanes_) take_bodies(slot, bodies[i], bodies[j], across);
    if (batch_.count == kBatch) finish();
    return 0;
  }
  /// All that is left.
  void finish() {
    if (batch_.count == 0) return;
    world_.grains.shapes.template finish<World::Law::measures>(batch_);
    if constexpr (LawInLanes<typename World::Law>) {
      if (law_in_lanes_) {
        place_rows();
        const auto& rule = world_.acting.rule(0, 0);
        rule.law.lanes(batch_.overlaps, rule.friction, dt_, contacts_, batch_.count);
      }
    }
    for (int slot = 0; slot < batch_.count; ++slot) {
      if (!batch_.touches[slot]) {
        apart(first_[slot], pair_[slot]);
      } else if (!law_in_lanes_ || contacts_.left[slot] != 0) {
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

  void take_bodies(int slot, const Body& a, const Body& b, bool across) {
    contacts_.body_i[slot] = reinterpret_cast<const double*>(&a);
    contacts_.body_j[slot] = reinterpret_cast<const double*>(&b);
    contacts_.across[slot] = across ? 1 : 0;
    if (!across) return;
    const typename World::Vector drift = world_.cell.drift(world_.contacts.images[pair_[slot]]);
    for (int d = 0; d < 3; ++d) contacts_.drift[d][slot] = drift[d];
  }
  /// Where the law reads and writes. What is in no slot, or does not touch, has nothing of its own.
  void place_rows() {
    using Pair = typename World::Pair;
    static_assert(sizeof(Body) == 12 * sizeof(double) && sizeof(Force) == 9 * sizeof(double));
    static_assert(offsetof(Pair, memory) == 0 && sizeof(Pair) >= 4 * sizeof(double));
    for (int slot = 0; slot < batch_.count; ++slot) {
      const int k = pair_[slot];
      const bool touches = batch_.touches[slot];
      contacts_.memory[slot] =
          touches ? reinterpret_cast<double*>(&world_.contacts.pairs[k]) : contacts_.idle;
      contacts_.force[slot] =
          touches ? world_.contacts.pair_forces[k].force.data() : contacts_.idle;
    }
    for (int slot = batch_.count; slot < kBatch; ++slot) {
      contacts_.body_i[slot] = contacts_.body_i[0];
      contacts_.body_j[slot] = contacts_.body_j[0];
      contacts_.memory[slot] = contacts_.force[slot] = contacts_.idle;
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
