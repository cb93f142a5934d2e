// The step loop, compiled once per law and integrator (see engine.h for the algorithm).
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

// Skin of the neighbour list as a share of the mean radius, when none is given: larger means fewer
// searches and more candidate pairs; 0.1 is near the optimum for packings at rest and in flow.
inline constexpr double kSkinShare = 0.1;
// A grain that moves further than this share of its radius in one step has diverged: a contact
// would be crossed before it is seen.
inline constexpr double kMaxMoveShare = 0.5;
// A contact counts as sliding when its tangential force is within this share of the Coulomb limit.
inline constexpr double kSlidingMargin = 1e-6;

template <class Law, class Integrator>
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
    b.spin = g.fixed ? 0 : g.spin;
    b.radius = g.radius;
    const double mass = g.density * std::numbers::pi * g.radius * g.radius;
    if (!g.fixed) {
      b.inverse_mass = 1 / mass;
      b.inverse_inertia = 1 / (0.5 * mass * g.radius * g.radius);
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
    int i, j;       // bodies; of a wall pair j is the wall
    double spring;  // N, on i along (-n_y, n_x)
  };

  struct Gathered {
    double fx, fy, torque;
  };

  void search();
  void index_contacts();
  Gathered gather(int i) const;
  void sort_bodies(const std::vector<int>& order);
  void locate_applied();
  void begin_all(int first, int last);
  void forces(int rank, double dt);
  template <bool move_on>
  void end_all(int first, int last, long step_index);
  void start_new_grains();
  std::array<double, 2> applied_at(double t) const;
  void check_motion();
  LawForce evaluate(Pair& pair, const Body& a, const Body& b, Overlap& o, double mu, double dt,
                    ContactForce& force) const;
  bool overlap_of(const Pair& pair, bool wall, Overlap& o) const;
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
  double skin_ = 0;
  bool search_needed_ = true;
  std::atomic<bool> moved_{false}, diverged_{false};

  std::vector<Body> bodies_;
  std::vector<Memory> memory_;
  std::vector<double> masses_;
  std::vector<std::int64_t> ids_;
  std::vector<Wall> walls_;
  std::vector<std::array<double, 2>> reference_;  // positions at the last search

  std::vector<Pair> pairs_, wall_pairs_;
  std::vector<ContactForce> pair_forces_, wall_forces_;
  std::vector<int> first_start_, second_start_, second_pairs_, wall_start_;
  HierarchicalGrid grid_;
};

template <class Law, class Integrator>
inline void EngineLoop<Law, Integrator>::begin_all(int first, int last) {
  const double threshold = 0.25 * skin_ * skin_;
  bool moved = false;
  for (int i = first; i < last; ++i) {
    Body& b = bodies_[i];
    if (b.inverse_mass == 0) continue;
    integrator_.begin(b, memory_[i]);
    const double dx = b.x - reference_[i][0], dy = b.y - reference_[i][1];
    moved |= !(dx * dx + dy * dy <= threshold);  // also true for nan
  }
  if (moved) moved_.store(true, std::memory_order_relaxed);
}

/// Sum of the contact forces on grain i, in an order that no thread changes.
template <class Law, class Integrator>
inline auto EngineLoop<Law, Integrator>::gather(int i) const -> Gathered {
  double fx = 0, fy = 0, torque = 0;
  for (int k = first_start_[i]; k < first_start_[i + 1]; ++k) {
    fx += pair_forces_[k].fx;
    fy += pair_forces_[k].fy;
    torque += pair_forces_[k].torque_i;
  }
  for (int k = second_start_[i]; k < second_start_[i + 1]; ++k) {
    const ContactForce& f = pair_forces_[second_pairs_[k]];
    fx -= f.fx;
    fy -= f.fy;
    torque += f.torque_j;
  }
  for (int k = wall_start_[i]; k < wall_start_[i + 1]; ++k) {
    fx += wall_forces_[k].fx;
    fy += wall_forces_[k].fy;
    torque += wall_forces_[k].torque_i;
  }
  return {fx, fy, torque};
}

template <class Law, class Integrator>
inline std::array<double, 2> EngineLoop<Law, Integrator>::applied_at(double t) const {
  const double since = t - applied_.start;
  const double s = applied_.ramp > 0 ? std::clamp(since / applied_.ramp, 0.0, 1.0) : 1.0;
  const double part = s * s * (3 - 2 * s);
  return {applied_.fx * part, applied_.fy * part};
}

template <class Law, class Integrator>
template <bool move_on>
inline void EngineLoop<Law, Integrator>::end_all(int first, int last, long step_index) {
  const auto [load_x, load_y] =
      applied_at(static_cast<double>(step_index + 1) * settings_.time_step);
  const double threshold = 0.25 * skin_ * skin_;
  bool moved = false;
  for (int i = first; i < last; ++i) {
    Body& b = bodies_[i];
    if (b.inverse_mass == 0) continue;
    const Gathered sum = gather(i);
    double fx = sum.fx, fy = sum.fy;
    if (i == applied_index_) {
      fx += load_x;
      fy += load_y;
    }
    const double ax = fx * b.inverse_mass + settings_.gravity_x - background_ * b.vx;
    const double ay = fy * b.inverse_mass + settings_.gravity_y - background_ * b.vy;
    const double aspin = sum.torque * b.inverse_inertia - background_ * b.spin;
    integrator_.end(b, memory_[i], ax, ay, aspin);
    if constexpr (move_on) {
      integrator_.begin(b, memory_[i]);
      const double dx = b.x - reference_[i][0], dy = b.y - reference_[i][1];
      moved |= !(dx * dx + dy * dy <= threshold);
    }
  }
  if (moved) moved_.store(true, std::memory_order_relaxed);
}

template <class Law, class Integrator>
inline bool EngineLoop<Law, Integrator>::overlap_of(const Pair& pair, bool wall, Overlap& o) const {
  const Body& a = bodies_[pair.i];
  if (wall) {
    const Wall& w = walls_[pair.j];
    const double height = (a.x - w.point.x()) * w.normal.x() + (a.y - w.point.y()) * w.normal.y();
    return overlap_with_plane<Law::needs_area>(height, a.radius, w.normal.x(), w.normal.y(), o);
  }
  const Body& b = bodies_[pair.j];
  return overlap_of_disks<Law::needs_area>(b.x - a.x, b.y - a.y, a.radius, b.radius, o);
}

template <class Law, class Integrator>
inline LawForce EngineLoop<Law, Integrator>::evaluate(Pair& pair, const Body& a, const Body& b,
                                                      Overlap& o, double mu, double dt,
                                                      ContactForce& force) const {
  const double vx = a.vx - b.vx, vy = a.vy - b.vy;
  ContactMotion m;
  m.approach = vx * o.nx + vy * o.ny;
  m.slip = vy * o.nx - vx * o.ny + a.spin * o.arm_i + b.spin * o.arm_j;
  m.inverse_mass_i = a.inverse_mass;
  m.inverse_mass_j = b.inverse_mass;
  m.inverse_inertia_i = a.inverse_inertia;
  m.inverse_inertia_j = b.inverse_inertia;
  const LawForce f = law_(o, m, mu, dt, pair.spring);
  force.fx = -f.normal * o.nx - f.tangential * o.ny;
  force.fy = -f.normal * o.ny + f.tangential * o.nx;
  force.torque_i = o.arm_i * f.tangential;
  force.torque_j = o.arm_j * f.tangential;
  return f;
}

template <class Law, class Integrator>
inline void EngineLoop<Law, Integrator>::forces(int rank, double dt) {
  const double mu = settings_.friction;
  Overlap o;
  const auto [first, last] = share(static_cast<int>(pairs_.size()), rank, team_.size());
  for (int k = first; k < last; ++k) {
    Pair& pair = pairs_[k];
    const Body& a = bodies_[pair.i];
    const Body& b = bodies_[pair.j];
    if (!overlap_of_disks<Law::needs_area>(b.x - a.x, b.y - a.y, a.radius, b.radius, o)) {
      pair.spring = 0;
      pair_forces_[k] = ContactForce{};
      continue;
    }
    evaluate(pair, a, b, o, mu, dt, pair_forces_[k]);
  }
  static const Body kWallBody{};  // at rest, of infinite mass
  const auto [wall_first, wall_last] =
      share(static_cast<int>(wall_pairs_.size()), rank, team_.size());
  for (int k = wall_first; k < wall_last; ++k) {
    Pair& pair = wall_pairs_[k];
    if (!overlap_of(pair, true, o)) {
      pair.spring = 0;
      wall_forces_[k] = ContactForce{};
      continue;
    }
    evaluate(pair, bodies_[pair.i], kWallBody, o, walls_[pair.j].friction, dt, wall_forces_[k]);
  }
}

template <class Law, class Integrator>
void EngineLoop<Law, Integrator>::step(long n) {
  if (n <= 0) return;
  if (search_needed_) search();
  if (first_new_ < static_cast<std::int64_t>(ids_.size())) start_new_grains();
  const int count = static_cast<int>(bodies_.size());
  const long start = steps_;
  moved_ = false;
  team_.run([&](int rank) {
    const auto [first, last] = share(count, rank, team_.size());
    begin_all(first, last);
    for (long s = 0; s < n; ++s) {
      team_.meet();
      if (moved_.load(std::memory_order_relaxed)) {
        team_.meet();  // all have read the flag
        if (rank == 0) {
          steps_ = start + s;
          check_motion();
          if (!diverged_) search();
          moved_ = false;
        }
        team_.meet();
        if (diverged_) return;
      }
      forces(rank, settings_.time_step);
      team_.meet();
      if (s + 1 < n) {
        end_all<true>(first, last, start + s);
      } else {
        end_all<false>(first, last, start + s);
      }
    }
  });
  if (diverged_) report_divergence();
  steps_ = start + n;
}

/// Grains added since the last step get the acceleration of where they stand, so that the first
/// step is as accurate as any other. A zero time step leaves the springs as they are.
template <class Law, class Integrator>
void EngineLoop<Law, Integrator>::start_new_grains() {
  for (int rank = 0; rank < team_.size(); ++rank) forces(rank, 0);
  const auto [load_x, load_y] = applied_at(time());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& b = bodies_[i];
    if (b.inverse_mass == 0 || ids_[i] < first_new_) continue;
    const Gathered sum = gather(static_cast<int>(i));
    const bool loaded = static_cast<int>(i) == applied_index_;
    integrator_.start(memory_[i],
                      (sum.fx + (loaded ? load_x : 0)) * b.inverse_mass + settings_.gravity_x -
                          background_ * b.vx,
                      (sum.fy + (loaded ? load_y : 0)) * b.inverse_mass + settings_.gravity_y -
                          background_ * b.vy,
                      sum.torque * b.inverse_inertia - background_ * b.spin);
  }
  first_new_ = static_cast<std::int64_t>(ids_.size());
}

template <class Law, class Integrator>
void EngineLoop<Law, Integrator>::check_motion() {
  for (const Body& b : bodies_) {
    const double move = std::hypot(b.vx, b.vy) * settings_.time_step;
    if (!(move <= kMaxMoveShare * b.radius) || !std::isfinite(b.x) || !std::isfinite(b.y)) {
      diverged_ = true;
    }
  }
}

template <class Law, class Integrator>
void EngineLoop<Law, Integrator>::report_divergence() const {
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

template <class Law, class Integrator>
void EngineLoop<Law, Integrator>::locate_applied() {
  applied_index_ = -1;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (ids_[i] == applied_.id) applied_index_ = static_cast<int>(i);
  }
}

template <class Law, class Integrator>
void EngineLoop<Law, Integrator>::sort_bodies(const std::vector<int>& order) {
  const std::size_t n = order.size();
  std::vector<int> rank(n);
  for (std::size_t k = 0; k < n; ++k) rank[order[k]] = static_cast<int>(k);
  const auto permute = [&order, n](auto& values) {
    auto sorted = values;
    for (std::size_t k = 0; k < n; ++k) sorted[k] = values[order[k]];
    values.swap(sorted);
  };
  permute(bodies_);
  permute(memory_);
  permute(masses_);
  permute(ids_);
  for (Pair& p : pairs_) {
    p.i = rank[p.i];
    p.j = rank[p.j];
    if (p.i > p.j) std::swap(p.i, p.j);  // the spring is the same seen from either side
  }
  for (Pair& p : wall_pairs_) p.i = rank[p.i];
  locate_applied();
}

template <class Law, class Integrator>
void EngineLoop<Law, Integrator>::search() {
  const int n = static_cast<int>(bodies_.size());
  if (settings_.skin > 0) {
    skin_ = settings_.skin;
  } else {
    double sum = 0;
    for (const Body& b : bodies_) sum += b.radius;
    skin_ = n > 0 ? kSkinShare * sum / n : 0;
  }
  grid_.build(bodies_, skin_);
  if (n > 0) {
    sort_bodies(grid_.z_order(bodies_));
    grid_.build(bodies_, skin_);
  }

  // New lists; springs move over from the old ones by (i, j).
  const auto by_indices = [](const Pair& a, const Pair& b) {
    return a.i != b.i ? a.i < b.i : a.j < b.j;
  };
  const auto carry_springs = [&](std::vector<Pair>& old, std::vector<Pair>& fresh) {
    std::erase_if(old, [](const Pair& p) { return p.spring == 0; });
    std::sort(old.begin(), old.end(), by_indices);
    auto it = old.begin();
    for (Pair& p : fresh) {
      while (it != old.end() && by_indices(*it, p)) ++it;
      if (it != old.end() && it->i == p.i && it->j == p.j) p.spring = it->spring;
    }
    old.swap(fresh);
  };
  std::vector<std::pair<int, int>> found;
  grid_.pairs(bodies_, found);
  std::vector<Pair> fresh;
  fresh.reserve(found.size());
  for (const auto& [i, j] : found) fresh.push_back({i, j, 0});
  carry_springs(pairs_, fresh);

  fresh.clear();
  for (int i = 0; i < n; ++i) {
    const Body& b = bodies_[i];
    if (b.inverse_mass == 0) continue;
    for (int w = 0; w < static_cast<int>(walls_.size()); ++w) {
      const Wall& wall = walls_[w];
      const double height =
          (b.x - wall.point.x()) * wall.normal.x() + (b.y - wall.point.y()) * wall.normal.y();
      if (height < b.radius + skin_) fresh.push_back({i, w, 0});
    }
  }
  carry_springs(wall_pairs_, fresh);

  index_contacts();
  pair_forces_.assign(pairs_.size(), {});
  wall_forces_.assign(wall_pairs_.size(), {});
  reference_.resize(n);
  for (int i = 0; i < n; ++i) reference_[i] = {bodies_[i].x, bodies_[i].y};
  search_needed_ = false;
}

/// Where each grain finds its contacts.
template <class Law, class Integrator>
void EngineLoop<Law, Integrator>::index_contacts() {
  const int n = static_cast<int>(bodies_.size());
  const auto count_starts = [n](const std::vector<Pair>& list, std::vector<int>& start,
                                bool second) {
    start.assign(n + 1, 0);
    for (const Pair& p : list) ++start[(second ? p.j : p.i) + 1];
    for (int i = 0; i < n; ++i) start[i + 1] += start[i];
  };
  count_starts(pairs_, first_start_, false);
  count_starts(pairs_, second_start_, true);
  count_starts(wall_pairs_, wall_start_, false);
  second_pairs_.resize(pairs_.size());
  std::vector<int> cursor(second_start_.begin(), second_start_.end());
  for (int k = 0; k < static_cast<int>(pairs_.size()); ++k)
    second_pairs_[cursor[pairs_[k].j]++] = k;
}

template <class Law, class Integrator>
Diagnostics EngineLoop<Law, Integrator>::measure() const {
  Diagnostics d;
  const int n = static_cast<int>(bodies_.size());
  std::vector<std::array<double, 2>> resultant(n, {0, 0});
  double force_sum = 0;
  const auto visit = [&](const Pair& pair, const ContactForce& f, bool wall) {
    Overlap o;
    const double size = std::hypot(f.fx, f.fy);
    if (size == 0 || !overlap_of(pair, wall, o)) return;
    ++d.contacts;
    force_sum += size;
    d.elastic_energy += law_.energy(o, pair.spring);
    const double radius =
        wall ? bodies_[pair.i].radius : std::min(bodies_[pair.i].radius, bodies_[pair.j].radius);
    d.max_overlap_ratio = std::max(d.max_overlap_ratio, o.depth / radius);
    const double normal = -(f.fx * o.nx + f.fy * o.ny);
    const double tangential = f.fy * o.nx - f.fx * o.ny;
    const double mu = wall ? walls_[pair.j].friction : settings_.friction;
    if (mu > 0 && std::fabs(tangential) >= mu * normal * (1 - kSlidingMargin)) ++d.sliding;
    resultant[pair.i][0] += f.fx;
    resultant[pair.i][1] += f.fy;
    if (!wall) {
      resultant[pair.j][0] -= f.fx;
      resultant[pair.j][1] -= f.fy;
    }
  };
  if (!search_needed_) {
    for (std::size_t k = 0; k < pairs_.size(); ++k) visit(pairs_[k], pair_forces_[k], false);
    for (std::size_t k = 0; k < wall_pairs_.size(); ++k)
      visit(wall_pairs_[k], wall_forces_[k], true);
  }
  d.height = -std::numeric_limits<double>::infinity();
  const auto [load_x, load_y] = applied_at(time());
  for (int i = 0; i < n; ++i) {
    const Body& b = bodies_[i];
    if (b.inverse_mass == 0) continue;
    d.kinetic_energy +=
        0.5 * masses_[i] * (b.vx * b.vx + b.vy * b.vy) + 0.5 * b.spin * b.spin / b.inverse_inertia;
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

template <class Law, class Integrator>
Snapshot EngineLoop<Law, Integrator>::snapshot() const {
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
  const auto visit = [&](const Pair& pair, const ContactForce& f, bool wall) {
    Overlap o;
    if ((f.fx == 0 && f.fy == 0) || !overlap_of(pair, wall, o)) return;
    const Body& a = bodies_[pair.i];
    Contact c;
    c.i = ids_[pair.i];
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
  };
  if (!search_needed_) {
    for (std::size_t k = 0; k < pairs_.size(); ++k) visit(pairs_[k], pair_forces_[k], false);
    for (std::size_t k = 0; k < wall_pairs_.size(); ++k)
      visit(wall_pairs_[k], wall_forces_[k], true);
  }
  std::sort(s.contacts.begin(), s.contacts.end(),
            [](const Contact& a, const Contact& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
  s.attributes["integrator"] = Integrator::name;
  s.attributes["law"] = Law::name;
  s.attributes["time_step"] = fmt::format("{:.17g}", settings_.time_step);
  return s;
}

template <class Law, class Integrator>
std::string EngineLoop<Law, Integrator>::image() const {
  ImageWriter w;
  w.put(background_);
  w.put(applied_);
  w.put(steps_);
  w.put(free_);
  w.put(first_new_);
  w.put(skin_);
  w.put(search_needed_);
  w.put(bodies_);
  w.put(memory_);
  w.put(masses_);
  w.put(ids_);
  w.put(reference_);
  w.put(pairs_);
  w.put(wall_pairs_);
  w.put(pair_forces_);
  w.put(wall_forces_);
  return w.bytes();
}

template <class Law, class Integrator>
void EngineLoop<Law, Integrator>::restore(const std::string& image) {
  ImageReader r(image);
  r.get(background_);
  r.get(applied_);
  r.get(steps_);
  r.get(free_);
  r.get(first_new_);
  r.get(skin_);
  r.get(search_needed_);
  r.get(bodies_);
  r.get(memory_);
  r.get(masses_);
  r.get(ids_);
  r.get(reference_);
  r.get(pairs_);
  r.get(wall_pairs_);
  r.get(pair_forces_);
  r.get(wall_forces_);
  r.finish();
  const int n = static_cast<int>(bodies_.size());
  for (const Pair& p : pairs_) r.require(p.i >= 0 && p.i < p.j && p.j < n);
  for (const Pair& p : wall_pairs_) {
    r.require(p.i >= 0 && p.i < n && p.j >= 0 && p.j < static_cast<int>(walls_.size()));
  }
  r.require(memory_.size() == bodies_.size() && ids_.size() == bodies_.size() &&
            masses_.size() == bodies_.size() && pair_forces_.size() == pairs_.size() &&
            wall_forces_.size() == wall_pairs_.size());
  if (!search_needed_) index_contacts();
  locate_applied();
}

}  // namespace grainfield::dem
