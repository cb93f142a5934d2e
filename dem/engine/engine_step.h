// One step: forces of the pairs in a fixed order, then the motion of the grains (see engine.h for
// the algorithm).
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dem/engine/engine_loop.h"

namespace grainfield::dem {

template <class Shape, class Law, class Integrator>
inline void EngineLoop<Shape, Law, Integrator>::begin(int i, bool& moved) {
  Body& b = bodies_[i];
  integrator_.begin(b, memory_[i]);
  if constexpr (Shape::outlines) shapes_.place(i, b, memory_[i].angle);
  const Reference& r = reference_[i];
  const double dx = b.x - r.x, dy = b.y - r.y;
  double left = r.way;
  if constexpr (Shape::outlines) left -= r.turning * std::fabs(memory_[i].angle - r.angle);
  moved |= !(left >= 0 && dx * dx + dy * dy <= left * left);  // also true for nan
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::begin_all(int rank) {
  bool moved = false;
  for (int i = blocks_[rank]; i < blocks_[rank + 1]; ++i) {
    if (bodies_[i].inverse_mass != 0) begin(i, moved);
  }
  if (moved) moved_.store(true, std::memory_order_relaxed);
}

template <class Shape, class Law, class Integrator>
inline std::array<double, 2> EngineLoop<Shape, Law, Integrator>::applied_at(double t) const {
  const double since = t - applied_.start;
  const double s = applied_.ramp > 0 ? std::clamp(since / applied_.ramp, 0.0, 1.0) : 1.0;
  const double part = s * s * (3 - 2 * s);
  return {applied_.fx * part, applied_.fy * part};
}

template <class Shape, class Law, class Integrator>
inline bool EngineLoop<Shape, Law, Integrator>::overlap_with_wall(int i, const Wall& w,
                                                                  Overlap& o) const {
  return shapes_.template overlap_plane<Law::needs_area>(i, bodies_[i], w.point.x(), w.point.y(),
                                                         w.normal.x(), w.normal.y(), o);
}

/// The contact point, from the first grain.
template <class Shape, class Law, class Integrator>
std::array<double, 2> EngineLoop<Shape, Law, Integrator>::point_of(const Body& a,
                                                                   const Overlap& o) {
  if constexpr (Shape::outlines) {
    return {a.x + o.lever_i * o.nx - o.shift_i * o.ny, a.y + o.lever_i * o.ny + o.shift_i * o.nx};
  }
  return {a.x + o.arm_i * o.nx, a.y + o.arm_i * o.ny};
}

/// With levers and shifts as in Overlap: velocities and torques at the contact point.
template <class Shape, class Law, class Integrator>
inline ContactForce EngineLoop<Shape, Law, Integrator>::evaluate(const Body& a, const Body& b,
                                                                 const Overlap& o, double mu,
                                                                 double dt, double& spring) const {
  const double vx = a.vx - b.vx, vy = a.vy - b.vy;
  ContactMotion m;
  m.approach = vx * o.nx + vy * o.ny;
  if constexpr (Shape::outlines) {
    m.approach += b.spin * o.shift_j - a.spin * o.shift_i;
    m.slip = vy * o.nx - vx * o.ny + a.spin * o.lever_i + b.spin * o.lever_j;
  } else {
    m.slip = vy * o.nx - vx * o.ny + a.spin * o.arm_i + b.spin * o.arm_j;
  }
  m.inverse_mass_i = a.inverse_mass;
  m.inverse_mass_j = b.inverse_mass;
  m.inverse_inertia_i = a.inverse_inertia;
  m.inverse_inertia_j = b.inverse_inertia;
  const LawForce f = law_(o, m, mu, dt, spring);
  const double fx = -f.normal * o.nx - f.tangential * o.ny;
  const double fy = -f.normal * o.ny + f.tangential * o.nx;
  if constexpr (Shape::outlines) {
    return {fx, fy, o.lever_i * f.tangential + o.shift_i * f.normal,
            o.lever_j * f.tangential - o.shift_j * f.normal};
  }
  return {fx, fy, o.arm_i * f.tangential, o.arm_j * f.tangential};
}

/// Force of pair k between grains i and j; 0 and an empty memory when they do not touch.
template <class Shape, class Law, class Integrator>
inline bool EngineLoop<Shape, Law, Integrator>::pair_force(int i, int k, double dt,
                                                           ContactForce& force) {
  Pair& pair = pairs_[k];
  const Body& a = bodies_[i];
  const Body& b = bodies_[pair.j];
  Overlap o;
  if (!shapes_.template overlap<Law::needs_area>(i, a, pair.j, b, pair.feature, o)) {
    pair.spring = 0;
    return false;
  }
  force = evaluate(a, b, o, settings_.friction, dt, pair.spring);
  return true;
}

/// Pairs that reach from an earlier thread's block into this one's. They come first in the sum of
/// their second grain, as they do when one thread sweeps all.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::incoming(int rank, double dt) {
  for (const auto& [i, k] : incoming_[rank]) {
    ContactForce& f = pair_forces_[k];
    if (!pair_force(i, k, dt, f)) {
      f = ContactForce{};
      continue;
    }
    Sum& sum = sums_[pairs_[k].j];
    sum.fx -= f.fx;
    sum.fy -= f.fy;
    sum.torque += f.torque_j;
  }
}

/// The sweep over a block: grain i is complete once its own pairs (i, j > i) are done, because
/// those with j < i were done at j; so it moves at once and no later pair needs its old place.
template <class Shape, class Law, class Integrator>
template <SweepKind kind>
void EngineLoop<Shape, Law, Integrator>::sweep(int rank, long step_index, double dt) {
  static const Body kWallBody{};  // at rest, of infinite mass
  const int first = blocks_[rank], last = blocks_[rank + 1];
  const auto [load_x, load_y] =
      applied_at(static_cast<double>(step_index + 1) * settings_.time_step);
  bool moved = false;
  for (int i = first; i < last; ++i) {
    __builtin_prefetch(&memory_[i] + kAhead / 2, 1);
    double fx = sums_[i].fx, fy = sums_[i].fy, torque = sums_[i].torque;
    sums_[i] = Sum{};
    for (int k = pair_start_[i]; k < pair_start_[i + 1]; ++k) {
      const int j = pairs_[k].j;
      const int later = pairs_[k + kAhead].j;
      __builtin_prefetch(&bodies_[later], 1);
      __builtin_prefetch(&sums_[later], 1);
      ContactForce f;
      if (j >= awake_) {  // a sleeper, or fixed: it only remembers what it feels
        const bool touches = pair_force(i, k, dt, f);
        if constexpr (kind == SweepKind::last) pair_forces_[k] = f;
        if (!touches) continue;
        if constexpr (kind != SweepKind::start) {
          felt_[k].fx += f.fx;
          felt_[k].fy += f.fy;
          felt_[k].torque += f.torque_j;
          felt_[k].press += std::fabs(f.fx) + std::fabs(f.fy);
        }
      } else if (j >= last) {
        f = pair_forces_[k];  // the block of j has evaluated it
      } else if (pair_force(i, k, dt, f)) {
        sums_[j].fx -= f.fx;
        sums_[j].fy -= f.fy;
        sums_[j].torque += f.torque_j;
        if constexpr (kind == SweepKind::last) pair_forces_[k] = f;
      } else {
        if constexpr (kind == SweepKind::last) pair_forces_[k] = f;
        continue;
      }
      fx += f.fx;
      fy += f.fy;
      torque += f.torque_i;
    }
    Body& b = bodies_[i];
    if (b.inverse_mass == 0) continue;
    for (int k = wall_start_[i]; k < wall_start_[i + 1]; ++k) {
      Pair& pair = wall_pairs_[k];
      const Wall& wall = walls_[pair.j];
      Overlap o;
      ContactForce f;
      if (overlap_with_wall(i, wall, o)) {
        f = evaluate(b, kWallBody, o, wall.friction, dt, pair.spring);
        fx += f.fx;
        fy += f.fy;
        torque += f.torque_i;
      } else {
        pair.spring = 0;
      }
      if constexpr (kind == SweepKind::last) wall_forces_[k] = f;
    }
    if (i == applied_index_) {
      fx += load_x;
      fy += load_y;
    }
    const double ax = fx * b.inverse_mass + settings_.gravity_x - background_ * b.vx;
    const double ay = fy * b.inverse_mass + settings_.gravity_y - background_ * b.vy;
    const double aspin = torque * b.inverse_inertia - background_ * b.spin;
    if constexpr (kind == SweepKind::start) {
      if (ids_[i] >= first_new_) integrator_.start(memory_[i], ax, ay, aspin);
    } else {
      integrator_.end(b, memory_[i], ax, ay, aspin);
      if constexpr (kind == SweepKind::move_on) begin(i, moved);
    }
  }
  if (moved) moved_.store(true, std::memory_order_relaxed);
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::step(long n) {
  if (n <= 0) return;
  if (diverged_) report_divergence();
  if (search_needed_) search(false);
  const double dt = settings_.time_step;
  const long start = steps_;
  moved_ = false;
  if (first_new_ < static_cast<std::int64_t>(ids_.size())) start_new_grains();
  team_.run([&](int rank) {
    begin_all(rank);
    for (long s = 0; s < n; ++s) {
      team_.meet();
      const bool review_due =
          settings_.sleep.on && start + s > 0 && (start + s) % kReviewEvery == 0;
      const bool smaller_skin = start + s - last_by_motion_ >= kSeldom && skin_share_ > kLeastSkin;
      if (moved_.load(std::memory_order_relaxed) || smaller_skin || review_due) {
        team_.meet();  // all have read the flags
        if (rank == 0) {
          const bool search_due = moved_.load(std::memory_order_relaxed) || smaller_skin;
          steps_ = start + s;
          check_motion();
          if (!diverged_ && review_due) review();
          if (!diverged_ && (search_due || search_needed_)) search(search_due);
          moved_ = false;
        }
        team_.meet();
        if (diverged_) return;
      }
      incoming(rank, dt);
      team_.meet();
      if (s + 1 < n) {
        sweep<SweepKind::move_on>(rank, start + s, dt);
      } else {
        sweep<SweepKind::last>(rank, start + s, dt);
      }
    }
  });
  if (!diverged_) {
    steps_ = start + n;
    check_motion();  // a grain that only spins is not searched for
  }
  if (diverged_) report_divergence();
}

/// Grains added since the last step get the acceleration of where they stand, so that their first
/// step is as accurate as any other. The contacts' memories stay as they are.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::start_new_grains() {
  const std::vector<Pair> pairs = pairs_, wall_pairs = wall_pairs_;
  team_.run([&](int rank) {
    incoming(rank, 0);
    team_.meet();
    sweep<SweepKind::start>(rank, steps_ - 1, 0);
  });
  pairs_ = pairs;
  wall_pairs_ = wall_pairs;
  first_new_ = static_cast<std::int64_t>(ids_.size());
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::check_motion() {
  for (int i = 0; i < awake_; ++i) {
    const Body& b = bodies_[i];
    const double move = std::hypot(b.vx, b.vy) * settings_.time_step;
    if (!(move <= kMaxMoveShare * b.radius) || !is_finite(b)) diverged_ = true;
  }
}

/// A speed that is not finite shows in how far the grain moves.
template <class Shape, class Law, class Integrator>
inline bool EngineLoop<Shape, Law, Integrator>::is_finite(const Body& b) {
  return std::isfinite(b.x) && std::isfinite(b.y) && std::isfinite(b.spin);
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::report_divergence() const {
  for (int i = 0; i < awake_; ++i) {
    const Body& b = bodies_[i];
    const double speed = std::hypot(b.vx, b.vy);
    if (speed * settings_.time_step <= kMaxMoveShare * b.radius && is_finite(b)) continue;
    if (!std::isfinite(speed) || !is_finite(b)) {
      throw ComputationFailed(fmt::format(
          "diverged at t = {:.6g} s (step {}): grain {} last seen near ({:.4g}, {:.4g}) m has a "
          "place, speed or spin that is not a finite number; lower motion.time_step (now {:.3g} "
          "s), "
          "damping or stiffness, or give grains of a usual size",
          time(), steps_, ids_[i], reference_[i].x, reference_[i].y, settings_.time_step));
    }
    throw ComputationFailed(fmt::format(
        "diverged at t = {:.6g} s (step {}): grain {} last seen near ({:.4g}, {:.4g}) m at {:.3g} "
        "m/s "
        "moves more than half its radius in a step; lower motion.time_step (now {:.3g} s) or the "
        "load",
        time(), steps_, ids_[i], reference_[i].x, reference_[i].y, speed, settings_.time_step));
  }
  throw ComputationFailed("diverged");
}

}  // namespace grainfield::dem
