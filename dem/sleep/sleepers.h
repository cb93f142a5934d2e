// Who sleeps, who has been quiet for long enough, and what a sleeper feels.
//
// Bodies [0, awake) move; the others sleep or, while there is sleeping, are fixed. All decisions
// follow from step counts and states alone and are made by one thread, so the bits stay.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dem/sleep/frozen_contacts.h"
#include "dem/sleep/sleep_settings.h"
#include "dem/space/body.h"

namespace grainfield::dem {

template <int D, class Memory>
class Sleepers {
 public:
  using Vector = VectorOf<D>;
  using Rotation = RotationOf<D>;
  using Sum = ForceSum<D>;

  FrozenContacts<D, Memory> frozen;

  /// A new body, the last one.
  void add(const Vector& position, const Rotation& rotation, long step, bool asleep) {
    asleep_.push_back(asleep ? 1 : 0);
    quiet_.push_back({position, rotation, step});
    rests_.push_back({});
    touches_.push_back({});
    changed_ |= asleep;
  }
  bool is_asleep(int i) const { return asleep_[i] != 0; }
  int size() const { return static_cast<int>(asleep_.size()); }

  /// Awake bodies come to the front, by swap(i, j) of everything that is kept by body; returns
  /// their number.
  template <class Swap>
  int part(int awake_before, Swap swap_bodies) {
    int low = 0, high = size() - 1;
    while (true) {
      while (low <= high && !asleep_[low]) ++low;
      while (low <= high && asleep_[high]) --high;
      if (low >= high) break;
      std::swap(quiet_[low], quiet_[high]);
      std::swap(rests_[low], rests_[high]);
      std::swap(touches_[low], touches_[high]);
      std::swap(asleep_[low], asleep_[high]);
      swap_bodies(low, high);
      changed_ = true;
    }
    if (low != awake_before) changed_ = true;
    return low;
  }
  /// The first bodies, all awake, in this order.
  void sort(const std::vector<int>& order) {
    std::vector<Quiet> sorted(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = quiet_[order[k]];
    std::copy(sorted.begin(), sorted.end(), quiet_.begin());
  }
  /// The bodies behind the awake ones are other ones since settled() was called.
  bool have_changed() const { return changed_; }
  void settled() { changed_ = false; }
  void set_changed() { changed_ = true; }

  /// True when the body was in the other state.
  bool set_asleep(int i, bool asleep, const Vector& position, const Rotation& rotation, long step) {
    if (is_asleep(i) == asleep) return false;
    asleep_[i] = asleep ? 1 : 0;
    quiet_[i] = {position, rotation, step};
    return true;
  }
  /// The body goes on at another image of its place.
  void shift(int i, const Vector& way) { quiet_[i].position += way; }
  /// Falls asleep: from now on it carries this weight.
  void put_to_sleep(int i, const Vector& weight) {
    asleep_[i] = 1;
    rests_[i] = {};
    rests_[i].force = weight;
    touches_[i] = {};
  }

  /// Steps for which a body has been within quiet_move of its diameter and turned as little; -1
  /// when it has just left that place.
  long quiet_steps(int i, const Vector& position, const Rotation& rotation, double radius,
                   long step, const SleepSettings& settings) {
    Quiet& q = quiet_[i];
    const double limit = settings.quiet_move * 2 * radius;
    const double turn = Space<D>::angle_between(rotation, q.rotation) * radius;
    if (!((position - q.position).squaredNorm() <= limit * limit) || !(turn <= limit)) {
      q = {position, rotation, step};
      return -1;
    }
    return step - q.since;
  }

  /// What a sleeper carries: its weight and the frozen contacts.
  Sum& rest(int i) { return rests_[i]; }
  /// A frozen contact is felt anew from now on: it leaves what the sleeper carries.
  void release(int i, const ContactForce<D>& on_sleeper) {
    Sum& rest = rests_[i];
    rest.force -= on_sleeper.force;
    rest.torque -= on_sleeper.torque_i;
    rest.press -= sum_of_sizes(on_sleeper.force);
  }
  /// What a sleeper has felt of awake neighbours, summed over the steps since the last review.
  void touch(int i, const Sum& felt) {
    Sum& t = touches_[i];
    t.force -= felt.force;
    t.torque += felt.torque;
    t.press += felt.press;
  }
  void forget_touches(int i) { touches_[i] = Sum{}; }
  /// True when weight, frozen contacts and the mean touch of `steps` steps leave more than
  /// wake_force of the forces unbalanced; also for nan.
  bool is_unbalanced(int i, double radius, long steps, const SleepSettings& settings) const {
    const double share = steps > 0 ? 1.0 / static_cast<double>(steps) : 0.0;
    const Sum &rest = rests_[i], &touch = touches_[i];
    const Vector force = rest.force + share * touch.force;
    const SpinOf<D> torque = rest.torque + share * touch.torque;
    const double press = rest.press + share * touch.press;
    const double unbalanced = sum_of_sizes(force) + sum_of_sizes(torque) / radius;
    return !(unbalanced <= settings.wake_force * press);
  }

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.changed_);
    each(self.asleep_);
    each(self.quiet_);
    each(self.rests_);
    each(self.touches_);
  }
  bool fits(std::size_t grains) const {
    return asleep_.size() == grains && quiet_.size() == grains && rests_.size() == grains &&
           touches_.size() == grains;
  }

 private:
  /// Since when, and from where, a grain has hardly moved.
  struct Quiet {
    Vector position = zero<Vector>();
    Rotation rotation = no_rotation<Rotation>();
    long since = 0;
  };

  bool changed_ = true;
  std::vector<unsigned char> asleep_;
  std::vector<Quiet> quiet_;
  std::vector<Sum> rests_;    // of sleepers: weight and forces of the frozen contacts
  std::vector<Sum> touches_;  // of sleepers: forces of awake neighbours, summed over the steps
};

}  // namespace grainfield::dem
