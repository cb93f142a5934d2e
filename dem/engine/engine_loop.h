// The step loop, compiled once per shape, law and integrator (see engine.h for the algorithm).
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "dem/engine/engine.h"
#include "dem/engine/image.h"
#include "dem/engine/thread_team.h"
#include "dem/neighbours/hierarchical_grid.h"

namespace grainfield::dem {

// Skin of the neighbour list as a share of the mean radius, when none is given. A large one means
// few searches and many idle pairs: it grows when a search comes within kOften steps of the last,
// and shrinks when none was needed for kSeldom steps. At rest 0.03 was the fastest of 0.01, 0.03
// and 0.1 on the settled packings of tests/benchmarks. Step counts alone decide, so the bits stay.
inline constexpr double kFirstSkin = 0.1, kLeastSkin = 0.03, kMostSkin = 0.4;
inline constexpr long kOften = 60, kSeldom = 1000;
// How many pairs ahead the sweep asks for the grains it will need; the pair list ends with as many
// idle entries. Measured: 8 % on packings beyond the second-level cache, none below.
inline constexpr int kAhead = 16;
// A grain that moves further than this share of its radius in one step has diverged: a contact
// would be crossed before it is seen.
inline constexpr double kMaxMoveShare = 0.5;
// A contact counts as sliding when its tangential force is within this share of the Coulomb limit.
inline constexpr double kSlidingMargin = 1e-6;

enum class SweepKind {
  start,    ///< only the acceleration of new grains
  move_on,  ///< end the step and begin the next
  last      ///< end the step and keep the forces for measure() and snapshot()
};

template <class Shape, class Law, class Integrator>
class EngineLoop final : public Engine {
 public:
  using Memory = typename Integrator::Memory;

  EngineLoop(const EngineSettings& settings, const Law& law)
      : settings_(settings), law_(law), integrator_(settings.time_step), team_(settings.threads) {}

  std::int64_t add(const NewGrain& g) override {
    Body b;
    b.x = g.x;
    b.y = g.y;
    b.vx = g.fixed ? 0 : g.vx;
    b.vy = g.fixed ? 0 : g.vy;
    b.spin = g.fixed || !g.rotates ? 0 : g.spin;
    b.radius = g.radius;
    const double mass = g.density * std::numbers::pi * g.radius * g.radius;
    if (!g.fixed) {
      b.inverse_mass = 1 / mass;
      if (g.rotates) b.inverse_inertia = 1 / (0.5 * mass * g.radius * g.radius);
      ++free_;
    }
    Memory m;
    m.angle = g.angle;
    bodies_.push_back(b);
    memory_.push_back(m);
    masses_.push_back(mass);
    ids_.push_back(static_cast<std::int64_t>(ids_.size()));
    search_needed_ = true;
    return ids_.back();
  }

  void add_wall(const Wall& wall) override {
    walls_.push_back(wall);
    search_needed_ = true;
  }

  void apply(const AppliedForce& force) override {
    applied_ = force;
    locate_applied();
  }

  void set_background_damping(double rate) override { background_ = rate; }

  void set_gravity(double gx, double gy) override {
    settings_.gravity_x = gx;
    settings_.gravity_y = gy;
  }
  void set_sleep(bool on) override { settings_.sleep.on = on; }

  void step(long n) override;

  double time() const override { return static_cast<double>(steps_) * settings_.time_step; }
  long steps() const override { return steps_; }
  int grains() const override { return free_; }
  double time_step() const override { return settings_.time_step; }
  Diagnostics measure() const override;
  Snapshot snapshot() const override;
  std::string image() const override;
  void restore(const std::string& image) override;

 private:
  struct Pair {
    double spring = 0;  // N, on the first grain along (-n_y, n_x)
    int j = 0;          // second grain, or wall; the first is the row's
    int pad = 0;        // so that an image has no undefined bytes
  };
  struct alignas(32) Sum {
    double fx = 0, fy = 0, torque = 0;
  };

  void search();
  void adapt_skin();
  void index_contacts();
  void sort_bodies(const std::vector<int>& order);
  void locate_applied();
  void begin(int i, bool& moved);
  void begin_all(int rank);
  void incoming(int rank, double dt);
  template <SweepKind kind>
  void sweep(int rank, long step_index, double dt);
  bool pair_force(int i, int k, double dt, ContactForce& force);
  std::array<double, 2> applied_at(double t) const;
  void start_new_grains();
  void check_motion();
  ContactForce evaluate(const Body& a, const Body& b, const Overlap& o, double mu, double dt,
                        double& spring) const;
  bool overlap_with_wall(const Body& a, const Wall& w, Overlap& o) const;
  template <class Visit>
  void visit_contacts(Visit visit) const;
  [[noreturn]] void report_divergence() const;

  EngineSettings settings_;
  Law law_;
  Integrator integrator_;
  ThreadTeam team_;
  double background_ = 0;
  AppliedForce applied_;
  int applied_index_ = -1;
  long steps_ = 0;
  int free_ = 0;
  std::int64_t first_new_ = 0;  // ids from here on have not been started yet
  double skin_ = 0, skin_share_ = kFirstSkin;
  long last_search_ = 0;
  bool search_needed_ = true;
  std::atomic<bool> moved_{false}, diverged_{false};

  std::vector<Body> bodies_;
  std::vector<Memory> memory_;
  std::vector<double> masses_;
  std::vector<std::int64_t> ids_;
  std::vector<Wall> walls_;
  std::vector<std::array<double, 2>> reference_;  // positions at the last search

  // Candidate pairs by first grain (rows pair_start_[i] .. pair_start_[i+1]), likewise with walls.
  std::vector<Pair> pairs_, wall_pairs_;
  std::vector<int> pair_start_, wall_start_;
  std::vector<ContactForce> pair_forces_, wall_forces_;  // of the last step of step(n)
  std::vector<Sum> sums_;    // what earlier grains have left for a later one; 0 between steps
  std::vector<int> blocks_;  // first grain of each thread's block, and the end
  std::vector<std::vector<std::pair<int, int>>> incoming_;  // per block: (i, pair)
  HierarchicalGrid grid_;
};

template <class Shape, class Law, class Integrator>
inline void EngineLoop<Shape, Law, Integrator>::begin(int i, bool& moved) {
  Body& b = bodies_[i];
  integrator_.begin(b, memory_[i]);
  const double dx = b.x - reference_[i][0], dy = b.y - reference_[i][1];
  moved |= !(dx * dx + dy * dy <= 0.25 * skin_ * skin_);  // also true for nan
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
inline bool EngineLoop<Shape, Law, Integrator>::overlap_with_wall(const Body& a, const Wall& w,
                                                                  Overlap& o) const {
  const double height = (a.x - w.point.x()) * w.normal.x() + (a.y - w.point.y()) * w.normal.y();
  return Shape::template overlap_with_plane<Law::needs_area>(a, height, w.normal.x(), w.normal.y(),
                                                             o);
}

template <class Shape, class Law, class Integrator>
inline ContactForce EngineLoop<Shape, Law, Integrator>::evaluate(const Body& a, const Body& b,
                                                                 const Overlap& o, double mu,
                                                                 double dt, double& spring) const {
  const double vx = a.vx - b.vx, vy = a.vy - b.vy;
  ContactMotion m;
  m.approach = vx * o.nx + vy * o.ny;
  m.slip = vy * o.nx - vx * o.ny + a.spin * o.arm_i + b.spin * o.arm_j;
  m.inverse_mass_i = a.inverse_mass;
  m.inverse_mass_j = b.inverse_mass;
  m.inverse_inertia_i = a.inverse_inertia;
  m.inverse_inertia_j = b.inverse_inertia;
  const LawForce f = law_(o, m, mu, dt, spring);
  return {-f.normal * o.nx - f.tangential * o.ny, -f.normal * o.ny + f.tangential * o.nx,
          o.arm_i * f.tangential, o.arm_j * f.tangential};
}

/// Force of pair k between grains i and j; 0 and an empty memory when they do not touch.
template <class Shape, class Law, class Integrator>
inline bool EngineLoop<Shape, Law, Integrator>::pair_force(int i, int k, double dt,
                                                           ContactForce& force) {
  Pair& pair = pairs_[k];
  const Body& a = bodies_[i];
  const Body& b = bodies_[pair.j];
  Overlap o;
  if (!Shape::template overlap<Law::needs_area>(a, b, o)) {
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
      if (j >= last) {
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
      if (overlap_with_wall(b, wall, o)) {
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
  if (search_needed_) search();
  const double dt = settings_.time_step;
  const long start = steps_;
  moved_ = false;
  if (first_new_ < static_cast<std::int64_t>(ids_.size())) start_new_grains();
  team_.run([&](int rank) {
    begin_all(rank);
    for (long s = 0; s < n; ++s) {
      team_.meet();
      const bool smaller_skin = start + s - last_search_ >= kSeldom && skin_share_ > kLeastSkin;
      if (moved_.load(std::memory_order_relaxed) || smaller_skin) {
        team_.meet();  // all have read the flags
        if (rank == 0) {
          steps_ = start + s;
          check_motion();
          if (!diverged_) search();
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
  if (diverged_) report_divergence();
  steps_ = start + n;
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
  for (const Body& b : bodies_) {
    const double move = std::hypot(b.vx, b.vy) * settings_.time_step;
    if (!(move <= kMaxMoveShare * b.radius) || !std::isfinite(b.x) || !std::isfinite(b.y)) {
      diverged_ = true;
    }
  }
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::report_divergence() const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& b = bodies_[i];
    const double speed = std::hypot(b.vx, b.vy);
    if (speed * settings_.time_step <= kMaxMoveShare * b.radius && std::isfinite(b.x) &&
        std::isfinite(b.y)) {
      continue;
    }
    throw ComputationFailed(fmt::format(
        "diverged at t = {:.6g} s (step {}): grain {} last seen near ({:.4g}, {:.4g}) m at {:.3g} "
        "m/s "
        "moves more than half its radius in a step; lower motion.time_step (now {:.3g} s) or the "
        "load",
        time(), steps_, ids_[i], reference_[i][0], reference_[i][1], speed, settings_.time_step));
  }
  throw ComputationFailed("diverged");
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::locate_applied() {
  applied_index_ = -1;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (ids_[i] == applied_.id) applied_index_ = static_cast<int>(i);
  }
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::sort_bodies(const std::vector<int>& order) {
  const std::size_t n = order.size();
  const auto permute = [&order, n](auto& values) {
    auto sorted = values;
    for (std::size_t k = 0; k < n; ++k) sorted[k] = values[order[k]];
    values.swap(sorted);
  };
  permute(bodies_);
  permute(memory_);
  permute(masses_);
  permute(ids_);
  locate_applied();
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::adapt_skin() {
  const long since = steps_ - last_search_;
  last_search_ = steps_;
  if (since < kOften) {
    skin_share_ = std::min(1.5 * skin_share_, kMostSkin);
  } else if (since >= kSeldom) {
    skin_share_ = std::max(0.5 * skin_share_, kLeastSkin);
  }
  double sum = 0;
  for (const Body& b : bodies_) sum += b.radius;
  const double mean = bodies_.empty() ? 0 : sum / static_cast<double>(bodies_.size());
  skin_ = settings_.skin > 0 ? settings_.skin : skin_share_ * mean;
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::search() {
  const int n = static_cast<int>(bodies_.size());
  adapt_skin();
  // The springs in use, by the grains' ids: the order of the bodies changes below. A spring is the
  // same seen from either of its grains.
  struct Kept {
    std::int64_t i, j;
    double spring;
  };
  const auto less = [](const Kept& a, const Kept& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; };
  const auto keep = [&](const std::vector<Pair>& pairs, const std::vector<int>& start, bool wall) {
    std::vector<Kept> kept;
    for (int i = 0; i + 1 < static_cast<int>(start.size()); ++i) {
      for (int k = start[i]; k < start[i + 1]; ++k) {
        if (pairs[k].spring == 0) continue;
        const std::int64_t j = wall ? pairs[k].j : ids_[pairs[k].j];
        kept.push_back(wall ? Kept{ids_[i], j, pairs[k].spring}
                            : Kept{std::min(ids_[i], j), std::max(ids_[i], j), pairs[k].spring});
      }
    }
    std::sort(kept.begin(), kept.end(), less);
    return kept;
  };
  const std::vector<Kept> kept = keep(pairs_, pair_start_, false);
  const std::vector<Kept> wall_kept = keep(wall_pairs_, wall_start_, true);
  const auto find = [&](const std::vector<Kept>& list, std::int64_t i, std::int64_t j) {
    const Kept key{i, j, 0};
    const auto it = std::lower_bound(list.begin(), list.end(), key, less);
    return it != list.end() && it->i == i && it->j == j ? it->spring : 0.0;
  };

  grid_.build(bodies_, skin_);
  if (n > 0) {
    sort_bodies(grid_.order(bodies_));
    grid_.build(bodies_, skin_);
  }
  std::vector<std::pair<int, int>> found;
  grid_.pairs(bodies_, found);
  pairs_.clear();
  pair_start_.assign(n + 1, 0);
  for (const auto& [i, j] : found) {
    ++pair_start_[i + 1];
    pairs_.push_back({find(kept, std::min(ids_[i], ids_[j]), std::max(ids_[i], ids_[j])), j, 0});
  }
  for (int i = 0; i < n; ++i) pair_start_[i + 1] += pair_start_[i];
  pairs_.resize(found.size() + kAhead);

  wall_pairs_.clear();
  wall_start_.assign(1, 0);
  for (int i = 0; i < n; ++i) {
    const Body& b = bodies_[i];
    for (int w = 0; w < static_cast<int>(walls_.size()) && b.inverse_mass != 0; ++w) {
      const Wall& wall = walls_[w];
      const double height =
          (b.x - wall.point.x()) * wall.normal.x() + (b.y - wall.point.y()) * wall.normal.y();
      if (height < b.radius + skin_) wall_pairs_.push_back({find(wall_kept, ids_[i], w), w, 0});
    }
    wall_start_.push_back(static_cast<int>(wall_pairs_.size()));
  }
  index_contacts();
  pair_forces_.assign(pairs_.size(), {});
  wall_forces_.assign(wall_pairs_.size(), {});
  reference_.resize(n);
  for (int i = 0; i < n; ++i) reference_[i] = {bodies_[i].x, bodies_[i].y};
  search_needed_ = false;
}

/// Blocks of the threads, with about the same number of pairs in each, and what crosses them.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::index_contacts() {
  const int n = static_cast<int>(bodies_.size()), size = team_.size();
  blocks_.assign(size + 1, n);
  blocks_[0] = 0;
  const auto work = [&](int i) { return static_cast<long long>(pair_start_[i]) + 2LL * i; };
  for (int rank = 1, i = 0; rank < size; ++rank) {
    while (i < n && work(i) * size < work(n) * rank) ++i;
    blocks_[rank] = i;
  }
  incoming_.assign(size, {});
  for (int from = 0; from + 1 < size; ++from) {
    for (int i = blocks_[from]; i < blocks_[from + 1]; ++i) {
      for (int k = pair_start_[i]; k < pair_start_[i + 1]; ++k) {
        if (pairs_[k].j < blocks_[from + 1]) continue;
        int to = from + 1;
        while (pairs_[k].j >= blocks_[to + 1]) ++to;
        incoming_[to].emplace_back(i, k);
      }
    }
  }
  sums_.assign(n, Sum{});
}

/// visit(first grain, pair, force, is a wall, overlap) for every contact that carried force in the
/// last step.
template <class Shape, class Law, class Integrator>
template <class Visit>
void EngineLoop<Shape, Law, Integrator>::visit_contacts(Visit visit) const {
  if (search_needed_) return;
  Overlap o;
  for (int i = 0; i < static_cast<int>(bodies_.size()); ++i) {
    const Body& a = bodies_[i];
    for (int k = pair_start_[i]; k < pair_start_[i + 1]; ++k) {
      const ContactForce& f = pair_forces_[k];
      const Body& b = bodies_[pairs_[k].j];
      if ((f.fx != 0 || f.fy != 0) && Shape::template overlap<Law::needs_area>(a, b, o)) {
        visit(i, pairs_[k], f, false, o);
      }
    }
    for (int k = wall_start_[i]; k < wall_start_[i + 1]; ++k) {
      const ContactForce& f = wall_forces_[k];
      if ((f.fx != 0 || f.fy != 0) && overlap_with_wall(a, walls_[wall_pairs_[k].j], o)) {
        visit(i, wall_pairs_[k], f, true, o);
      }
    }
  }
}

template <class Shape, class Law, class Integrator>
Diagnostics EngineLoop<Shape, Law, Integrator>::measure() const {
  Diagnostics d;
  const int n = static_cast<int>(bodies_.size());
  std::vector<std::array<double, 2>> resultant(n, {0, 0});
  double force_sum = 0;
  visit_contacts([&](int i, const Pair& pair, const ContactForce& f, bool wall, const Overlap& o) {
    ++d.contacts;
    force_sum += std::hypot(f.fx, f.fy);
    d.elastic_energy += law_.energy(o, pair.spring);
    const double radius =
        wall ? bodies_[i].radius : std::min(bodies_[i].radius, bodies_[pair.j].radius);
    d.max_overlap_ratio = std::max(d.max_overlap_ratio, o.depth / radius);
    const double normal = -(f.fx * o.nx + f.fy * o.ny);
    const double tangential = f.fy * o.nx - f.fx * o.ny;
    const double mu = wall ? walls_[pair.j].friction : settings_.friction;
    if (mu > 0 && std::fabs(tangential) >= mu * normal * (1 - kSlidingMargin)) ++d.sliding;
    resultant[i][0] += f.fx;
    resultant[i][1] += f.fy;
    if (!wall) {
      resultant[pair.j][0] -= f.fx;
      resultant[pair.j][1] -= f.fy;
    }
  });
  d.height = -std::numeric_limits<double>::infinity();
  const auto [load_x, load_y] = applied_at(time());
  for (int i = 0; i < n; ++i) {
    const Body& b = bodies_[i];
    if (b.inverse_mass == 0) continue;
    d.kinetic_energy += 0.5 * masses_[i] * (b.vx * b.vx + b.vy * b.vy) +
                        (b.inverse_inertia > 0 ? 0.5 * b.spin * b.spin / b.inverse_inertia : 0.0);
    double fx = resultant[i][0] + masses_[i] * settings_.gravity_x;
    double fy = resultant[i][1] + masses_[i] * settings_.gravity_y;
    if (i == applied_index_) {
      fx += load_x;
      fy += load_y;
    }
    const double size = std::hypot(fx, fy);
    d.mean_unbalanced_force += size;
    d.max_unbalanced_force = std::max(d.max_unbalanced_force, size);
    d.height = std::max(d.height, b.y + b.radius);
  }
  if (free_ > 0) d.mean_unbalanced_force /= free_;
  if (d.contacts > 0) d.mean_contact_force = force_sum / d.contacts;
  d.unbalanced_force_ratio = d.mean_contact_force > 0
                                 ? d.mean_unbalanced_force / d.mean_contact_force
                                 : std::numeric_limits<double>::infinity();
  return d;
}

template <class Shape, class Law, class Integrator>
Snapshot EngineLoop<Shape, Law, Integrator>::snapshot() const {
  Snapshot s;
  s.time = time();
  s.gravity = Vec3(settings_.gravity_x, settings_.gravity_y, 0);
  s.walls = walls_;
  const int n = static_cast<int>(bodies_.size());
  s.grains.resize(n);
  for (int i = 0; i < n; ++i) {
    const Body& b = bodies_[i];
    Grain& g = s.grains[ids_[i]];  // ids are 0..n-1
    g.id = ids_[i];
    g.position = Vec3(b.x, b.y, 0);
    g.velocity = Vec3(b.vx, b.vy, 0);
    g.angle = memory_[i].angle;
    g.spin = b.spin;
    g.radius = b.radius;
    g.mass = masses_[i];
    g.inertia = 0.5 * masses_[i] * b.radius * b.radius;
    g.volume = std::numbers::pi * b.radius * b.radius;
    g.fixed = b.inverse_mass == 0;
  }
  if (applied_index_ >= 0) {
    const auto [fx, fy] = applied_at(time());
    s.loaded_grain = applied_.id;
    s.applied_force = Vec3(fx, fy, 0);
  }
  visit_contacts([&](int i, const Pair& pair, const ContactForce& f, bool wall, const Overlap& o) {
    const Body& a = bodies_[i];
    Contact c;
    c.i = ids_[i];
    c.point = Vec3(a.x + o.arm_i * o.nx, a.y + o.arm_i * o.ny, 0);
    c.normal = Vec3(o.nx, o.ny, 0);
    c.force = Vec3(f.fx, f.fy, 0);
    c.j = wall ? -1 - pair.j : ids_[pair.j];
    if (!wall && c.j < c.i) {
      std::swap(c.i, c.j);
      c.normal = -c.normal;
      c.force = -c.force;
    }
    c.normal_force = -(f.fx * o.nx + f.fy * o.ny);
    c.tangential_force = f.fy * o.nx - f.fx * o.ny;
    c.spring = pair.spring;
    c.friction = wall ? walls_[pair.j].friction : settings_.friction;
    c.sliding = c.friction > 0 &&
                std::fabs(c.tangential_force) >= c.friction * c.normal_force * (1 - kSlidingMargin);
    s.contacts.push_back(c);
  });
  std::sort(s.contacts.begin(), s.contacts.end(),
            [](const Contact& a, const Contact& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
  s.attributes["integrator"] = Integrator::name;
  s.attributes["law"] = Law::name;
  s.attributes["time_step"] = fmt::format("{:.17g}", settings_.time_step);
  return s;
}

template <class Shape, class Law, class Integrator>
std::string EngineLoop<Shape, Law, Integrator>::image() const {
  ImageWriter w;
  w.put(background_);
  w.put(applied_);
  w.put(steps_);
  w.put(free_);
  w.put(first_new_);
  w.put(skin_);
  w.put(skin_share_);
  w.put(last_search_);
  w.put(search_needed_);
  w.put(bodies_);
  w.put(memory_);
  w.put(masses_);
  w.put(ids_);
  w.put(reference_);
  w.put(pair_start_);
  w.put(wall_start_);
  w.put(pairs_);
  w.put(wall_pairs_);
  w.put(pair_forces_);
  w.put(wall_forces_);
  return w.bytes();
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::restore(const std::string& image) {
  ImageReader r(image);
  r.get(background_);
  r.get(applied_);
  r.get(steps_);
  r.get(free_);
  r.get(first_new_);
  r.get(skin_);
  r.get(skin_share_);
  r.get(last_search_);
  r.get(search_needed_);
  r.get(bodies_);
  r.get(memory_);
  r.get(masses_);
  r.get(ids_);
  r.get(reference_);
  r.get(pair_start_);
  r.get(wall_start_);
  r.get(pairs_);
  r.get(wall_pairs_);
  r.get(pair_forces_);
  r.get(wall_forces_);
  r.finish();
  const int n = static_cast<int>(bodies_.size());
  for (const Pair& p : pairs_) r.require(p.j >= 0 && p.j < n);
  for (const Pair& p : wall_pairs_) r.require(p.j >= 0 && p.j < static_cast<int>(walls_.size()));
  if (!search_needed_) {
    r.require(static_cast<int>(pair_start_.size()) == n + 1 && pair_start_.front() == 0 &&
              pair_start_.back() + kAhead == static_cast<int>(pairs_.size()) &&
              std::is_sorted(pair_start_.begin(), pair_start_.end()) &&
              static_cast<int>(wall_start_.size()) == n + 1 && wall_start_.front() == 0 &&
              wall_start_.back() == static_cast<int>(wall_pairs_.size()) &&
              std::is_sorted(wall_start_.begin(), wall_start_.end()));
  }
  r.require(memory_.size() == bodies_.size() && ids_.size() == bodies_.size() &&
            masses_.size() == bodies_.size() && pair_forces_.size() == pairs_.size() &&
            wall_forces_.size() == wall_pairs_.size());
  if (!search_needed_) index_contacts();
  locate_applied();
}

}  // namespace grainfield::dem
