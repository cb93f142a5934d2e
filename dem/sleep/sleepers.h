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
#include "dem/sleep/turns.h"
#include "dem/space/body.h"

namespace grainfield::dem {

template <int D, class Memory>
class Sleepers {
 public:
  using Vector = VectorOf<D>;
  using Rotation = RotationOf<D>;
  using Sum = ForceSum<D>;

  FrozenContacts<D, Memory> frozen;

  /// How still a body has been.
  struct Stillness {
    long steps = 0;  ///< since it is within quiet_move of one place; below 0: not yet quiet
    double way = 0;  ///< from where it was then, in its diameters
  };
  /// What leaves a sleeper out of balance.
  struct Residual {
    Vector force = zero<Vector>();         ///< N
    SpinOf<D> torque = zero<SpinOf<D>>();  ///< N m
    double load = 0;                       ///< N
    double unbalanced(double radius) const { return force.norm() + size_of(torque) / radius; }
  };

  /// A new body, the last one.
  void add(const Vector& position, const Rotation& rotation, long step, bool asleep) {
    asleep_.push_back(asleep ? 1 : 0);
    stirred_.push_back(0);
    quiet_.push_back({position, rotation, position, rotation, step});
    rests_.push_back({});
    touches_.push_back({});
    lasting_.push_back({});
    hidden_.push_back({});
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
      std::swap(asleep_[low], asleep_[high]);
      std::swap(stirred_[low], stirred_[high]);
      std::swap(quiet_[low], quiet_[high]);
      std::swap(rests_[low], rests_[high]);
      std::swap(touches_[low], touches_[high]);
      std::swap(lasting_[low], lasting_[high]);
      std::swap(hidden_[low], hidden_[high]);
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

  /// True when the body was in the other state. It is quiet here since this step, also a later one.
  bool set_asleep(int i, bool asleep, const Vector& position, const Rotation& rotation, long step) {
    if (is_asleep(i) == asleep) return false;
    asleep_[i] = asleep ? 1 : 0;
    quiet_[i] = {position, rotation, position, rotation, step};
    return true;
  }
  /// Wakes a sleeper for a look: it must be quiet anew, but where it was quiet first, so that what
  /// it creeps from look to look adds up, and sleeps again there only with half of what is out of
  /// balance now: what neither relaxes nor moves it is none of the motion's.
  bool wake_for_look(int i, const Residual& residual, double radius, long step) {
    if (!is_asleep(i)) return false;
    asleep_[i] = 0;
    quiet_[i].since = step;
    quiet_[i].share = 0.5 * residual.unbalanced(radius) / residual.load;
    return true;
  }
  /// The body goes on at another image of its place.
  void shift(int i, const Vector& way) {
    quiet_[i].position += way;
    quiet_[i].last_position += way;
  }
  /// How a body has moved since the last review.
  struct Step {
    Vector way = zero<Vector>();         ///< m
    SpinOf<D> turn = zero<SpinOf<D>>();  ///< rad
  };
  Step since_review(int i, const Vector& position, const Rotation& rotation) const {
    const Quiet& q = quiet_[i];
    return {position - q.last_position, turn_between<D>(q.last_rotation, rotation)};
  }
  /// The place where an awake body is still goes along with what carries it: `carried` since the
  /// last review, which this one ends.
  void carry_place(int i, const Step& carried, const Vector& position, const Rotation& rotation) {
    Quiet& q = quiet_[i];
    q.position += carried.way;
    q.rotation = turned_by<D>(q.rotation, carried.turn);
    q.last_position = position;
    q.last_rotation = rotation;
  }
  /// Falls asleep: from now on it carries this weight.
  void put_to_sleep(int i, const Vector& weight) {
    asleep_[i] = 1;
    rests_[i] = {};
    rests_[i].force = weight;
    rests_[i].force_sum = weight.norm();
    touches_[i] = {};
    lasting_[i] = {};
    hidden_[i] = {};
  }

  /// How still an awake body is; its place is a new one when it leaves quiet_move.
  Stillness stillness(int i, const Vector& position, const Rotation& rotation, double radius,
                      long step, const SleepSettings& settings) {
    Quiet& q = quiet_[i];
    const double turn = Space<D>::angle_between(rotation, q.rotation) * radius;
    const double way = ((position - q.position).norm() + turn) / (2 * radius);
    if (!(way <= settings.quiet_move)) {
      q = {position, rotation, position, rotation, step};
      return {-1, 0};
    }
    return {step - q.since, way};
  }
  /// Out of balance by at most this share of its load an awake body may fall asleep.
  double sleeping_share(int i, const SleepSettings& settings) const {
    return std::min(settings.quiet_force, quiet_[i].share);
  }

  /// With more kinetic energy, J, an awake body may not fall asleep: what the force that sleeping
  /// may hide does on the way that it may. `load`: N.
  static double most_energy(double load, double radius, const SleepSettings& settings) {
    return settings.quiet_force * load * settings.quiet_move * 2 * radius;
  }

  /// What a sleeper carries: its weight and the frozen contacts.
  const Sum& rest(int i) const { return rests_[i]; }
  /// A contact has frozen: the sleeper carries its force.
  void carry(int i, const ContactForce<D>& on_sleeper) {
    Sum& rest = rests_[i];
    rest.force += on_sleeper.force;
    rest.torque += on_sleeper.torque_i;
    rest.force_sum += on_sleeper.force.norm();
    stir(i);
  }
  /// A frozen contact is felt anew from now on: it leaves what the sleeper carries.
  void release(int i, const ContactForce<D>& on_sleeper) {
    Sum& rest = rests_[i];
    rest.force -= on_sleeper.force;
    rest.torque -= on_sleeper.torque_i;
    rest.force_sum -= on_sleeper.force.norm();
    stir(i);
  }
  /// What a sleeper has felt of awake neighbours, summed over the steps since the last review.
  void touch(int i, const Sum& felt) {
    Sum& t = touches_[i];
    t.force -= felt.force;
    t.torque += felt.torque;
    t.force_sum += felt.force_sum;
    stir(i);
  }
  /// Its forces may be other ones than when it was judged last.
  void stir(int i) { stirred_[i] = 1; }
  bool is_stirred(int i) const { return stirred_[i] != 0; }
  /// `settled`: unless something stirs it, it would be judged as now.
  void set_judged(int i, bool settled) {
    stirred_[i] = settled ? 0 : 1;
    touches_[i] = Sum{};
  }
  /// Residual of weight, frozen contacts and the mean touch of `steps` steps.
  Residual residual(int i, long steps) const {
    const double share = steps > 0 ? 1.0 / static_cast<double>(steps) : 0.0;
    const Sum &rest = rests_[i], &touch = touches_[i];
    Sum mean;
    mean.force_sum = rest.force_sum + share * touch.force_sum;
    return {rest.force + share * touch.force, rest.torque + share * touch.torque, mean.load()};
  }
  /// The residual `now` joins the mean over the last reviews with this weight, at most 1; returns
  /// the mean, the weights of older ones falling exponentially. The first since it fell asleep is
  /// its own mean.
  const Residual& add_to_mean(int i, const Residual& now, double weight) {
    Residual& mean = lasting_[i];
    if (!(mean.load > 0)) weight = 1;
    mean.force += weight * (now.force - mean.force);
    mean.torque += weight * (now.torque - mean.torque);
    mean.load += weight * (now.load - mean.load);
    return mean;
  }
  /// Moves a sleeper in thought for `time`, s, as what is out of balance would move a free grain
  /// with the acceleration `gravity` times its share of the load. Returns how far it would have
  /// gone since it fell asleep, m. Imbalance that comes and goes does not add up.
  double creep(int i, const Residual& residual, double radius, double gravity, double time) {
    Hidden& h = hidden_[i];
    if (!(residual.load > 0)) return 0;
    const double step = gravity * time / residual.load;
    h.speed += step * residual.force;
    h.rim_speed += step / radius * residual.torque;
    h.way += time * h.speed;
    h.rim_way += time * h.rim_speed;
    return h.way.norm() + size_of(h.rim_way);
  }

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.changed_);
    each(self.asleep_);
    each(self.stirred_);
    each(self.quiet_);
    each(self.rests_);
    each(self.touches_);
    each(self.lasting_);
    each(self.hidden_);
  }
  bool fits(std::size_t grains) const {
    return asleep_.size() == grains && stirred_.size() == grains && quiet_.size() == grains &&
           rests_.size() == grains && touches_.size() == grains && lasting_.size() == grains &&
           hidden_.size() == grains;
  }

 private:
  /// Since when, and from where, a body has hardly moved.
  struct Quiet {
    Vector position = zero<Vector>();
    Rotation rotation = no_rotation<Rotation>();
    Vector last_position = zero<Vector>();  // at the last review
    Rotation last_rotation = no_rotation<Rotation>();
    long since = 0;
    double share = 1;  // after a look: out of balance by at most this share of its load there
  };

  /// Motion in thought of a sleeper.
  struct Hidden {
    Vector speed = zero<Vector>(), way = zero<Vector>();                   // m/s, m
    SpinOf<D> rim_speed = zero<SpinOf<D>>(), rim_way = zero<SpinOf<D>>();  // of its rim
  };

  bool changed_ = true;
  std::vector<unsigned char> asleep_;
  std::vector<unsigned char> stirred_;  // of sleepers
  std::vector<Quiet> quiet_;
  std::vector<Sum> rests_;         // of sleepers: weight and forces of the frozen contacts
  std::vector<Sum> touches_;       // of sleepers: forces of awake neighbours, summed over the steps
  std::vector<Residual> lasting_;  // of sleepers: the mean over the last reviews
  std::vector<Hidden> hidden_;     // of sleepers
};

}  // namespace grainfield::dem
