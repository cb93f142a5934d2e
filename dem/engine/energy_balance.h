// Where the energy of grains goes, measured at each contact.
//
// A contact takes -F.(v_i - v_j) - tau_i.w_i - tau_j.w_j from the two bodies; what it does not
// store it loses:
//   lost += -dt/2 (P(F_n) + P(F_{n+1})) - (E_{n+1} - E_n)
// with the velocities of the half step, which have moved the bodies from n to n+1. Velocity Verlet
// changes the kinetic energy by just that work and by dt^2/8 m (a_{n+1}^2 - a_n^2), which does not
// add up. So kinetic + elastic + potential + lost - work of walls and outer forces stays constant
// to second order in the time step. Of a law whose force is no gradient of what it says it stores,
// the work that it does by itself counts as lost, too (of either sign).
#pragma once
#include <cstdint>
#include <vector>

#include "dem/contacts/kept.h"
#include "dem/space/body.h"
#include "dem/space/lever.h"

namespace grainfield::dem {

/// Of one contact.
template <int D>
struct Account {
  ContactForce<D> before;  ///< in the step before
  double stored = 0;       ///< J
  double lost = 0;         ///< J, since the last search

  bool empty() const { return stored == 0 && before.force.isZero(0); }

  /// Before its first step: what is there already has not been lost.
  void begin(const ContactForce<D>& f, double stored_now) {
    if (!empty()) return;
    before = f;
    stored = stored_now;
  }
  /// A step in which bodies a and b have moved with their velocities.
  void add(const ContactForce<D>& f, double stored_now, const Body<D>& a, const Body<D>& b,
           double dt) {
    const VectorOf<D> force = before.force + f.force;
    const SpinOf<D> torque_a = before.torque_i + f.torque_i,
                    torque_b = before.torque_j + f.torque_j;
    const double power = force.dot(VectorOf<D>(a.velocity - b.velocity)) +
                         power_of(torque_a, a.spin) + power_of(torque_b, b.spin);
    lost -= 0.5 * dt * power + (stored_now - stored);
    before = f;
    stored = stored_now;
  }
};

/// Of the forces from outside on one grain that are no potential's: damping and an applied force.
template <int D>
struct OuterAccount {
  VectorOf<D> drag = zero<VectorOf<D>>();  ///< N, in the step before
  SpinOf<D> drag_torque = zero<SpinOf<D>>();
  VectorOf<D> applied = zero<VectorOf<D>>();
  double damped = 0, work = 0;  ///< J
};

template <int D>
struct EnergyBalance {
  bool on = false;
  std::vector<Account<D>> pairs, walls;  ///< as the list of contacts has them
  std::vector<OuterAccount<D>> outer;    ///< by grain's id
  double lost = 0;                       ///< in contacts before the last search, J

  /// What contacts have lost, in the order of the list.
  double lost_in_contacts() const {
    double sum = lost;
    for (const auto& account : pairs) sum += account.lost;
    for (const auto& account : walls) sum += account.lost;
    return sum;
  }

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.pairs);
    each(self.walls);
    each(self.outer);
    each(self.lost);
  }
  /// `searched`: no grain has come since the last search.
  bool fits(std::size_t pair_count, std::size_t wall_count, std::size_t grains,
            bool searched) const {
    if (!on) return pairs.empty() && walls.empty() && outer.empty();
    return pairs.size() == pair_count && walls.size() == wall_count && outer.size() <= grains &&
           (!searched || outer.size() == grains);
  }
};

/// The same account seen from the other grain: what it was before.
template <int D>
Account<D> turned(const Account<D>& account, bool other) {
  if (!other) return account;
  Account<D> out = account;
  out.before.force = -account.before.force;
  out.before.torque_i = account.before.torque_j;
  out.before.torque_j = account.before.torque_i;
  return out;
}

/// Takes the accounts out of the lists before a search, and puts them back after it.
template <class World>
class CarryAccounts {
 public:
  static constexpr int dim = World::dim;

  explicit CarryAccounts(World& world) : world_(world) {
    auto& balance = world.balance;
    if (!balance.on) return;
    balance.lost = balance.lost_in_contacts();
    const auto& ids = world.grains.ids;
    visit_list(world.contacts.pairs, balance.pairs, [&](int i, int j, const Account<dim>& account) {
      pairs_.add(pair_key(ids[i], ids[j]), turned(account, ids[i] > ids[j]));
    });
    visit_list(world.contacts.walls, balance.walls, [&](int i, int j, const Account<dim>& account) {
      walls_.add(wall_key(ids[i], j), account);
    });
    pairs_.sort();
    walls_.sort();
  }
  /// After the new list is there.
  void put_back() {
    auto& balance = world_.balance;
    if (!balance.on) return;
    const auto& ids = world_.grains.ids;
    balance.outer.resize(ids.size());
    fill_list(world_.contacts.pairs, balance.pairs, [&](int i, int j) {
      const Account<dim>* a = pairs_.find(pair_key(ids[i], ids[j]));
      return a == nullptr ? Account<dim>{} : turned(*a, ids[i] > ids[j]);
    });
    fill_list(world_.contacts.walls, balance.walls, [&](int i, int j) {
      const Account<dim>* a = walls_.find(wall_key(ids[i], j));
      return a == nullptr ? Account<dim>{} : *a;
    });
  }

 private:
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
        accounts[k].lost = 0;
      }
    }
  }

  World& world_;
  Kept<Account<dim>> pairs_, walls_;
};

}  // namespace grainfield::dem
