// Where the energy of grains goes, measured at each contact.
//
// A contact takes -F.(v_i - v_j) - tau_i.w_i - tau_j.w_j from the two bodies; what it does not
// store is gone:
//   gone += -dt/2 (P(F_n) + P(F_{n+1})) - (E_{n+1} - E_n)
// with the velocities of the half step, which have moved the bodies from n to n+1. Velocity Verlet
// changes the kinetic energy by just that work and by dt^2/8 m (a_{n+1}^2 - a_n^2), which does not
// add up. So the sum of Diagnostics::energy_balance stays 0 to second order in the time step.
//
// By the parts of the force (ContactParts) it has gone to the normal dashpot, to friction, to
// rolling and twisting. The rest is the law's own: what a force that is no gradient of the energy
// it states does by itself (overlap_area), and what a spring gains or loses as its stiffness
// changes (hertz). It has either sign, and counts as work of the law.
//
// A grain that falls asleep stops: its kinetic energy is booked as `stopped`. Its contacts end
// that step with the forces that they have at zero velocity. Those that freeze keep their accounts
// and what they store; those with grains awake go on, but what the sleeper has brought in that
// step is in their books (Account::stop). A sleeper that wakes starts from rest: nothing is booked.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "dem/contacts/kept.h"
#include "dem/engine/contact_losses.h"
#include "dem/laws/contact.h"
#include "dem/laws/rolling.h"
#include "dem/space/body.h"
#include "dem/space/lever.h"

namespace grainfield::dem {

/// What acts in a contact, by what takes energy, and what the contact stores.
template <int D>
struct ContactParts {
  ContactForce<D> all;                   ///< of it:
  ContactForce<D> dashpot;               ///< the normal force but for the elastic one
  ContactForce<D> along;                 ///< friction
  SpinOf<D> moment = zero<SpinOf<D>>();  ///< of rolling and twisting, on the first body
  ContactEnergy stored;                  ///< J
  double stored_rolling = 0;             ///< J
  double stiffening = 0;  ///< J, of stored.tangential: by a change of stiffness since the last step

  double stored_in_all() const { return stored.total() + stored_rolling; }
  /// The same seen from the other body.
  ContactParts turned() const {
    ContactParts out = *this;
    for (auto part : {&ContactParts::all, &ContactParts::dashpot, &ContactParts::along}) {
      (out.*part).force = -(this->*part).force;
      (out.*part).torque_i = (this->*part).torque_j;
      (out.*part).torque_j = (this->*part).torque_i;
    }
    out.moment = -moment;
    return out;
  }
};

/// Energies of one contact.
template <int D>
struct Account {
  ContactParts<D> before;  ///< in the step before
  ContactLosses gone;      ///< since the last search

  bool empty() const { return stored() == 0 && before.all.force.isZero(0); }
  double stored() const { return before.stored_in_all(); }  ///< J

  /// Before its first step: what is there already has been put in.
  void begin(const ContactParts<D>& now) {
    if (!empty()) return;
    before = now;
    before.stiffening = 0;
    gone.stored += now.stored_in_all();
  }
  /// A step in which bodies a and b have moved with their velocities.
  void add(const ContactParts<D>& now, const Body<D>& a, const Body<D>& b, double dt) {
    const Taken taken = taken_by(now, a, b, dt);
    const double friction =
        taken.along - now.stored.tangential + before.stored.tangential + now.stiffening;
    const double rolling = taken.rolling - now.stored_rolling + before.stored_rolling;
    const double all = taken.all - now.stored_in_all() + stored();
    gone += {taken.dashpot, friction, rolling, taken.dashpot + friction + rolling - all, 0};
    before = now;
  }
  /// What one of the two has brought in the step in which it stops, before the contact ends that
  /// step without it: add() then finds it at rest. a and b: the one that stops moves as it did, the
  /// other one rests.
  void stop(const ContactParts<D>& now, const Body<D>& a, const Body<D>& b, double dt) {
    const Taken taken = taken_by(now, a, b, dt);
    const double parts = taken.dashpot + taken.along + taken.rolling;
    gone += {taken.dashpot, taken.along, taken.rolling, parts - taken.all, 0};
  }

 private:
  /// J, from bodies in a step: by the parts of the force, and by all of it.
  struct Taken {
    double dashpot = 0, along = 0, rolling = 0, all = 0;
  };
  Taken taken_by(const ContactParts<D>& now, const Body<D>& a, const Body<D>& b, double dt) const {
    const auto taken = [&](const ContactForce<D>& first, const ContactForce<D>& second) {
      const VectorOf<D> force = first.force + second.force;
      const SpinOf<D> torque_a = first.torque_i + second.torque_i,
                      torque_b = first.torque_j + second.torque_j;
      return -0.5 * dt *
             (force.dot(VectorOf<D>(a.velocity - b.velocity)) + power_of(torque_a, a.spin) +
              power_of(torque_b, b.spin));
    };
    const double rolling =
        -0.5 * dt * power_of(SpinOf<D>(before.moment + now.moment), SpinOf<D>(a.spin - b.spin));
    return {taken(before.dashpot, now.dashpot), taken(before.along, now.along), rolling,
            taken(before.all, now.all)};
  }
};

/// What a contact has done in a step, as the interaction gives it.
template <int D, class Memory>
struct Acted {
  ContactForce<D> force;                     ///< moments of rolling included
  Memory before, after;                      ///< the law's
  SpinOf<D> moment = zero<SpinOf<D>>();      ///< of rolling and twisting, on the first body
  const RollingMemory<D>* rolled = nullptr;  ///< null: no resistance against it
};

/// The parts of what acts between two bodies that overlap. `on_second`: called with each part of
/// the force, where the torque on the second one is not that about its centroid.
template <bool central, class Rule, int D, class Memory, class OnSecond>
ContactParts<D> parts_of(const Rule& rule, const OverlapIn<D>& o, const Acted<D, Memory>& acted,
                         OnSecond on_second) {
  const ContactForce<D>& f = acted.force;
  ContactParts<D> parts;
  parts.all = f;
  parts.dashpot = forces_at<central>(o, repulsion_of(f.force, o) - rule.law.repulsion(o),
                                     zero<TangentialOf<D>>());
  parts.along = forces_at<central>(o, 0, tangential_of(f.force, o));
  on_second(parts.dashpot);
  on_second(parts.along);
  parts.moment = acted.moment;
  parts.stored = rule.law.energy(o, acted.after);
  if (acted.rolled != nullptr) parts.stored_rolling = rule.rolling.energy(*acted.rolled);
  if constexpr (requires { rule.law.stiffening(o, acted.before); }) {
    parts.stiffening = rule.law.stiffening(o, acted.before);
  }
  return parts;
}

/// Into the account of bodies a and b that overlap; dt = 0: before their first step.
template <bool central, class Rule, int D, class Memory, class OnSecond>
void book(Account<D>& account, const Rule& rule, const Body<D>& a, const Body<D>& b,
          const OverlapIn<D>& o, const Acted<D, Memory>& acted, double dt, OnSecond on_second) {
  const ContactParts<D> parts = parts_of<central>(rule, o, acted, on_second);
  if (dt > 0) {
    account.add(parts, a, b, dt);
  } else {
    account.begin(parts);
  }
}

/// Account of outer forces on one grain that have no potential: damping, an applied force and
/// the caller's own.
template <int D>
struct OuterAccount {
  VectorOf<D> drag = zero<VectorOf<D>>();  ///< N, in the step before
  SpinOf<D> drag_torque = zero<SpinOf<D>>();
  VectorOf<D> applied = zero<VectorOf<D>>();
  SpinOf<D> applied_torque = zero<SpinOf<D>>();
  double damped = 0, work = 0;  ///< J
};

template <int D>
struct EnergyBalance {
  bool on = false;
  std::vector<Account<D>> pairs, walls;  ///< as the list of contacts has them
  std::vector<OuterAccount<D>> outer;    ///< by grain's id
  ContactLosses gone;                    ///< in contacts before the last search
  /// A frozen contact by its key, seen from the grain with the lower id.
  struct Frozen {
    PairKey key = 0;
    Account<D> account;
  };
  std::vector<Frozen> frozen;
  double stopped = 0;  ///< J, kinetic, of grains when they fell asleep

  /// A grain falls asleep, with so much kinetic energy, J.
  void stop(double energy, std::int64_t id) {
    stopped += energy;
    if (static_cast<std::size_t>(id) >= outer.size()) return;
    outer[id].drag.setZero();
    outer[id].drag_torque = zero<SpinOf<D>>();
  }
  /// With grains that were added, and by changes of gravity, J.
  double brought_motion = 0, brought_height = 0;

  /// In contacts, in the order of the list.
  ContactLosses gone_in_contacts() const {
    ContactLosses sum = gone;
    for (const auto& account : pairs) sum += account.gone;
    for (const auto& account : walls) sum += account.gone;
    return sum;
  }

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.pairs);
    each(self.walls);
    each(self.outer);
    each(self.gone);
    each(self.frozen);
    each(self.stopped);
    each(self.brought_motion);
    each(self.brought_height);
  }
  /// `searched`: no grain has come since the last search.
  bool fits(std::size_t pair_count, std::size_t wall_count, std::size_t grains,
            bool searched) const {
    if (!on) return pairs.empty() && walls.empty() && outer.empty() && frozen.empty();
    return pairs.size() == pair_count && walls.size() == wall_count && outer.size() <= grains &&
           (!searched || outer.size() == grains);
  }
};

/// The same account seen from the other grain: what it was before.
template <int D>
Account<D> turned(const Account<D>& account, bool other) {
  if (!other) return account;
  return {account.before.turned(), account.gone};
}

/// Takes the accounts out of the lists before a search, and puts them back after it.
template <class World>
class CarryAccounts {
 public:
  static constexpr int dim = World::dim;

  explicit CarryAccounts(World& world) : world_(world) {
    auto& balance = world.balance;
    if (!balance.on) return;
    balance.gone = balance.gone_in_contacts();
    const auto& ids = world.grains.ids;
    visit_list(world.contacts.pairs, balance.pairs, [&](int i, int j, const Account<dim>& account) {
      pairs_.add(pair_key(ids[i], ids[j]), turned(account, ids[i] > ids[j]));
    });
    visit_list(world.contacts.walls, balance.walls, [&](int i, int j, const Account<dim>& account) {
      walls_.add(wall_key(ids[i], j), account);
    });
    for (const auto& f : balance.frozen) frozen_.add(f.key, f.account);
    pairs_.sort();
    walls_.sort();
    frozen_.sort();
  }
  /// After the new list is there.
  void put_back() {
    auto& balance = world_.balance;
    if (!balance.on) return;
    const auto& ids = world_.grains.ids;
    balance.outer.resize(ids.size());
    fill_list(world_.contacts.pairs, balance.pairs, [&](int i, int j) {
      return turned(recalled(pairs_, pair_key(ids[i], ids[j])), ids[i] > ids[j]);
    });
    fill_list(world_.contacts.walls, balance.walls,
              [&](int i, int j) { return recalled(walls_, wall_key(ids[i], j)); });
    balance.frozen.clear();
    for (const Kept<Account<dim>>* kept : {&pairs_, &walls_, &frozen_}) {
      kept->visit([&](PairKey key, Account<dim> account) {
        if (!world_.sleepers.frozen.has(key)) return;
        account.gone = {};
        balance.frozen.push_back({key, account});
      });
    }
    std::sort(balance.frozen.begin(), balance.frozen.end(),
              [](const auto& a, const auto& b) { return a.key < b.key; });
  }

 private:
  Account<dim> recalled(const Kept<Account<dim>>& kept, PairKey key) const {
    const Account<dim>* account = kept.find(key);
    if (account == nullptr) account = frozen_.find(key);
    return account == nullptr ? Account<dim>{} : *account;
  }
  template <class Rows, class Accounts, class Visit>
  static void visit_list(const Rows& rows, const Accounts& accounts, Visit visit) {
    if (accounts.size() < static_cast<std::size_t>(rows.size())) return;
    for (int i = 0; i < rows.rows(); ++i) {
      for (int k = rows.first(i); k < rows.last(i); ++k) {
        if (!accounts[k].empty()) visit(i, rows[k].j, accounts[k]);
      }
    }
  }
  template <class Rows, class Accounts, class Make>
  static void fill_list(const Rows& rows, Accounts& accounts, Make make) {
    accounts.assign(rows.with_idle(), {});
    for (int i = 0; i < rows.rows(); ++i) {
      for (int k = rows.first(i); k < rows.last(i); ++k) {
        accounts[k] = make(i, rows[k].j);
        accounts[k].gone = {};
      }
    }
  }

  World& world_;
  Kept<Account<dim>> pairs_, walls_, frozen_;
};

}  // namespace grainfield::dem
