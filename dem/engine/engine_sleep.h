// Sleeping and waking of grains in the step loop.
//
// Every kReviewEvery steps:
//   wake   a sleeper whose frozen forces, weight and the mean force of its awake neighbours since
//          the last review leave more than wake_force of the forces on it unbalanced; that an
//          awake neighbour touches at more than wake_speed sqrt(g d); or that lies within
//          wake_reach d v / sqrt(g d) of a grain that comes near sleepers (has one among its
//          candidate pairs) at such a speed v: the grains on which it falls must give way, and what
//          they pass on moves those behind;
//   sleep  a grain that has moved and turned by less than quiet_move of its diameter during
//          quiet_time, when its contacts' forces at zero velocity balance to quiet_force.
// A contact between two sleepers, or of a sleeper with a wall, is frozen: it keeps its spring and
// its force at zero velocity until one of them wakes. All of this follows from step counts and
// states alone and is done by one thread, so the bits stay.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dem/engine/engine_loop.h"

namespace grainfield::dem {

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::wake_all() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const bool fixed = bodies_[i].inverse_mass == 0;
    const unsigned char state = fixed && settings_.sleep.on ? 1 : 0;
    if (asleep_[i] == state) continue;
    asleep_[i] = state;
    quiet_[i] = {bodies_[i].x, bodies_[i].y, memory_[i].angle, steps_};
    search_needed_ = true;
  }
  locate_applied();
}

/// Weight, and the applied force at its full size (its grain does not sleep).
template <class Shape, class Law, class Integrator>
std::array<double, 3> EngineLoop<Shape, Law, Integrator>::weight_of(int i) const {
  return {inertias_[i].mass * settings_.gravity_x, inertias_[i].mass * settings_.gravity_y, 0};
}

/// Moves what the pairs have felt since the last search to their sleepers.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::gather_touches() {
  if (awake_ == static_cast<int>(asleep_.size()) || pair_start_.empty()) return;
  for (int i = 0; i + 1 < static_cast<int>(pair_start_.size()); ++i) {
    for (int k = pair_start_[i]; k < pair_start_[i + 1]; ++k) {
      const Sum& f = felt_[k];
      if (f.press == 0) continue;
      Sum& touch = touches_[pairs_[k].j];
      touch.fx -= f.fx;
      touch.fy -= f.fy;
      touch.torque += f.torque;
      touch.press += f.press;
      felt_[k] = {};
    }
  }
}

/// visit(i, j or wall, wall?, force, pair) for every contact of the active rows in which one of the
/// marked grains takes part, with the force that it would have at zero velocity.
template <class Shape, class Law, class Integrator>
template <class Visit>
void EngineLoop<Shape, Law, Integrator>::visit_static(const std::vector<unsigned char>& of,
                                                      Visit visit) {
  static const Body kWallBody{};
  const auto at_rest = [&](int i) {
    Body b = bodies_[i];
    b.vx = b.vy = b.spin = 0;
    return b;
  };
  Overlap o;
  for (int i = 0; i < awake_; ++i) {
    for (int k = pair_start_[i]; k < pair_start_[i + 1]; ++k) {
      Pair& pair = pairs_[k];
      if (!of[i] && !of[pair.j]) continue;
      const Body a = at_rest(i), b = at_rest(pair.j);
      if (!shapes_.template overlap<Law::needs_area>(i, a, pair.j, b, pair.feature, o)) continue;
      double spring = pair.spring;
      const ContactForce f = evaluate(a, b, o, settings_.friction, 0, spring);
      visit(i, pair.j, false, f, spring);
    }
    if (!of[i]) continue;
    for (int k = wall_start_[i]; k < wall_start_[i + 1]; ++k) {
      const Wall& wall = walls_[wall_pairs_[k].j];
      if (!overlap_with_wall(i, wall, o)) continue;
      double spring = wall_pairs_[k].spring;
      const ContactForce f = evaluate(at_rest(i), kWallBody, o, wall.friction, 0, spring);
      visit(i, wall_pairs_[k].j, true, f, spring);
    }
  }
}

template <class Shape, class Law, class Integrator>
bool EngineLoop<Shape, Law, Integrator>::wake_sleepers() {
  const SleepSettings& sleep = settings_.sleep;
  const int n = static_cast<int>(bodies_.size());
  const double g = std::hypot(settings_.gravity_x, settings_.gravity_y);
  bool any = false;
  const auto wake = [&](int j) {
    if (!asleep_[j] || bodies_[j].inverse_mass == 0) return;
    asleep_[j] = 0;
    quiet_[j] = {bodies_[j].x, bodies_[j].y, memory_[j].angle, steps_};
    any = true;
  };
  std::vector<int> shaken;
  for (int i = 0; i < awake_; ++i) {
    const Body& b = bodies_[i];
    const double speed2 = b.vx * b.vx + b.vy * b.vy;
    const double fast = sleep.wake_speed * sleep.wake_speed * g * 2 * b.radius;
    const auto near_sleepers = [&] {
      return std::any_of(pairs_.begin() + pair_start_[i], pairs_.begin() + pair_start_[i + 1],
                         [this](const Pair& pair) { return pair.j >= awake_; });
    };
    if (g > 0 && speed2 > fast && near_sleepers()) {
      const double reach = sleep.wake_reach * std::sqrt(speed2 * 2 * b.radius / g);
      shaken.clear();
      sleepers_grid_.near({b.x, b.y, b.radius + reach, false}, shaken);
      for (const int j : shaken) wake(awake_ + j);
    }
    for (int k = pair_start_[i]; k < pair_start_[i + 1]; ++k) {
      const int j = pairs_[k].j;
      if (j < awake_ || felt_[k].press == 0) continue;
      const double limit = sleep.wake_speed * sleep.wake_speed * g * 2 * bodies_[j].radius;
      if (speed2 > limit) wake(j);
    }
  }
  gather_touches();
  const double share = touch_steps_ > 0 ? 1.0 / static_cast<double>(touch_steps_) : 0.0;
  for (int j = awake_; j < n; ++j) {
    Sum& touch = touches_[j];
    if (bodies_[j].inverse_mass == 0) {
      touch = Sum{};
      continue;
    }
    const Sum& rest = rests_[j];
    const double fx = rest.fx + share * touch.fx, fy = rest.fy + share * touch.fy;
    const double torque = rest.torque + share * touch.torque;
    const double press = rest.press + share * touch.press;
    const double unbalanced = std::fabs(fx) + std::fabs(fy) + std::fabs(torque) / bodies_[j].radius;
    if (!(unbalanced <= sleep.wake_force * press)) wake(j);
    touch = Sum{};
  }
  return any;
}

template <class Shape, class Law, class Integrator>
bool EngineLoop<Shape, Law, Integrator>::let_sleep() {
  const SleepSettings& sleep = settings_.sleep;
  const int n = static_cast<int>(bodies_.size());
  std::vector<unsigned char> candidate(n, 0);
  bool any = false;
  for (int i = 0; i < awake_; ++i) {
    const Body& b = bodies_[i];
    Quiet& q = quiet_[i];
    const double limit = sleep.quiet_move * 2 * b.radius;
    const double angle = memory_[i].angle;
    const double dx = b.x - q.x, dy = b.y - q.y, turn = (angle - q.angle) * b.radius;
    if (!(dx * dx + dy * dy <= limit * limit) || !(std::fabs(turn) <= limit)) {
      q = {b.x, b.y, angle, steps_};
      continue;
    }
    const double quiet = static_cast<double>(steps_ - q.since) * settings_.time_step;
    if (quiet >= sleep.quiet_time && b.inverse_mass != 0 && i != applied_index_) {
      candidate[i] = 1;
      any = true;
    }
  }
  if (!any) return false;

  std::vector<Sum> sums(n);
  const auto add = [](Sum& sum, double sign, const ContactForce& f, double torque) {
    sum.fx += sign * f.fx;
    sum.fy += sign * f.fy;
    sum.torque += torque;
    sum.press += std::fabs(f.fx) + std::fabs(f.fy);
  };
  visit_static(candidate, [&](int i, int j, bool wall, const ContactForce& f, double) {
    add(sums[i], 1, f, f.torque_i);
    if (!wall) add(sums[j], -1, f, f.torque_j);
  });
  any = false;
  for (int i = 0; i < awake_; ++i) {
    if (!candidate[i]) continue;
    const auto [wx, wy, unused] = weight_of(i);
    const Sum& s = sums[i];
    const double unbalanced =
        std::fabs(s.fx + wx) + std::fabs(s.fy + wy) + std::fabs(s.torque) / bodies_[i].radius;
    if (!(s.press > 0 && unbalanced <= sleep.quiet_force * s.press)) {
      candidate[i] = 0;
      continue;
    }
    any = true;
    asleep_[i] = 1;
    Body& b = bodies_[i];
    b.vx = b.vy = b.spin = 0;
    const double angle = memory_[i].angle;
    memory_[i] = Memory{};
    memory_[i].angle = angle;
    rests_[i] = {wx, wy, 0, 0};
    touches_[i] = {};
  }
  if (!any) return false;
  visit_static(candidate, [&](int i, int j, bool wall, const ContactForce& f, double spring) {
    if (!asleep_[i] || (!wall && !asleep_[j])) return;
    add(rests_[i], 1, f, f.torque_i);
    const Key key = wall ? wall_key(ids_[i], j) : pair_key(ids_[i], ids_[j]);
    Frozen frozen{key, spring, f.fx, f.fy, f.torque_i, f.torque_j};
    if (!wall) {
      add(rests_[j], -1, f, f.torque_j);
      if (ids_[j] < ids_[i]) frozen = {key, spring, -f.fx, -f.fy, f.torque_j, f.torque_i};
    }
    frozen_[key] = frozen;
  });
  return true;
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::review() {
  touch_steps_ = kReviewEvery;
  const bool woken = wake_sleepers();
  if (let_sleep() || woken) search_needed_ = true;
}

}  // namespace grainfield::dem
