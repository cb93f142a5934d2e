// The engine: a world, and the parts that work on it, put together for one shape, law and
// integrator.
#pragma once
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "dem/computation_failed.h"
#include "dem/engine/engine.h"
#include "dem/engine/report.h"
#include "dem/engine/review.h"
#include "dem/engine/search.h"
#include "dem/engine/sweep.h"
#include "dem/engine/thread_team.h"
#include "dem/engine/turning.h"
#include "dem/engine/world.h"
#include "dem/engine/world_image.h"
#include "dem/image/image.h"
#include "dem/shapes/solid.h"

namespace grainfield::dem {

// A grain that moves further than this share of its radius in one step has diverged: a contact
// would be crossed before it is seen.
inline constexpr double kMaxMoveShare = 0.5;

template <class Shape, class Law, class Integrator>
class EngineLoop final : public Engine {
 public:
  using State = World<Shape, Law, Integrator>;
  static constexpr int dim = Shape::dim;

  /// `integrator`: its word. Throws std::invalid_argument for materials that do not fit.
  EngineLoop(const EngineSettings& settings, const Rules<Law>& rules, const char* integrator)
      : world_(world_of(settings, rules, integrator)),
        materials_(settings),
        search_(world_, settings.skin, settings.threads),
        review_(world_, search_),
        sweep_(world_),
        team_(settings.threads) {}

  std::int64_t add(const NewGrain& g) override {
    auto& grains = world_.grains;
    const int i = grains.size();
    const int kind = material_index(materials_, "grain", g.material);
    world_.acting.add_grain(kind);
    const Solid<dim> solid = grains.shapes.add({g.radius, g.outline});
    typename State::Body b;
    b.position = in_space<dim>({g.x, g.y, g.z});
    b.radius = solid.radius;
    const Inertia<dim> inertia{g.density * solid.volume, g.density * solid.moments, solid.volume};
    if (!g.fixed) {
      b.velocity = in_space<dim>({g.vx, g.vy, g.vz});
      b.inverse_mass = 1 / inertia.mass;
      if (g.rotates) take_turning(g, inertia, b);
      ++free_;
    }
    typename Integrator::Memory memory;
    memory.rotation = rotation_told(g, inertia);
    grains.bodies.push_back(b);
    grains.memory.push_back(memory);
    grains.inertias.push_back(inertia);
    grains.ids.push_back(i);
    grains.kinds.push_back(static_cast<std::uint8_t>(kind));
    world_.sleepers.add(b.position, memory.rotation, world_.steps, g.fixed && world_.sleep.on);
    grains.shapes.place(i, b, memory.rotation);
    world_.search_needed = true;
    return i;
  }

  void add_wall(const Wall& wall, const std::string& material) override {
    const int kind = material.empty() ? -1 : material_index(materials_, wall.name, material);
    world_.acting.add_wall(kind, wall.friction);
    world_.walls.add(wall);
    world_.search_needed = true;
  }
  void apply(const AppliedForce& force) override {
    world_.around.applied = force;
    world_.wake_all();
  }
  void set_background_damping(double rate) override { world_.around.drag = rate; }
  void set_gravity(double gx, double gy, double gz) override {
    world_.around.gravity = in_space<dim>({gx, gy, gz});
    world_.wake_all();
  }
  void set_sleep(bool on) override {
    world_.sleep.on = on;
    world_.wake_all();
  }

  void step(long n) override {
    if (n <= 0) return;
    if (world_.search_needed) search(false);
    const long start = world_.steps;
    sweep_.clear_moved();
    if (first_new_ < world_.grains.size()) start_new_grains();
    team_.run([&](int rank) {
      sweep_.begin_block(rank);
      for (long s = 0; s < n; ++s) {
        team_.meet();
        if (!between_steps(rank, start + s)) return;
        sweep_.incoming(rank, world_.time_step);
        team_.meet();
        const auto applied =
            world_.around.applied_at(static_cast<double>(start + s + 1) * world_.time_step);
        if (s + 1 < n) {
          sweep_.template run<SweepKind::move_on>(rank, applied, world_.time_step);
        } else {
          sweep_.template run<SweepKind::last>(rank, applied, world_.time_step);
        }
      }
    });
    if (!diverged_) {
      world_.steps = start + n;
      diverged_ = first_diverged() >= 0;  // a grain that only spins is not searched for
    }
    if (diverged_) report_divergence();
  }

  double time() const override { return world_.time(); }
  long steps() const override { return world_.steps; }
  int grains() const override { return free_; }
  double time_step() const override { return world_.time_step; }
  Diagnostics measure() const override { return Report(world_).measure(); }
  Motion motion() const override { return Report(world_).motion(); }
  Snapshot snapshot() const override { return Report(world_).snapshot(); }

  /// As frozen contacts without force: the next search hands their memories on.
  void remember(const std::vector<Contact>& contacts) override {
    for (const Contact& c : contacts) {
      typename State::Frozen frozen;
      frozen.key = c.j < 0 ? wall_key(c.i, static_cast<int>(-1 - c.j)) : pair_key(c.i, c.j);
      typename State::Memory memory;
      take_spring(c, memory.spring);
      frozen.memory = seen_from(memory, c.j >= 0 && c.j < c.i);
      world_.sleepers.frozen.keep(frozen);
    }
    world_.search_needed = true;
  }

  std::string image() const override {
    ImageWriter w;
    w.put(free_);
    w.put(first_new_);
    write_world(world_, search_, w);
    return w.bytes();
  }
  void restore(const std::string& image) override {
    ImageReader r(image);
    r.get(free_);
    r.get(first_new_);
    read_world(world_, search_, r);
    r.finish();
    for (const int kind : world_.grains.kinds) world_.acting.add_grain(kind);
    sweep_.reset();
  }

 private:
  static State world_of(const EngineSettings& settings, const Rules<Law>& rules,
                        const char* integrator) {
    State world;
    world.acting = typename State::Acting(rules);
    world.integrator = integrator;
    world.sleep = settings.sleep;
    world.time_step = settings.time_step;
    world.around.gravity =
        in_space<dim>({settings.gravity_x, settings.gravity_y, settings.gravity_z});
    return world;
  }

  void search(bool by_motion) {
    search_.run(by_motion);
    sweep_.reset();
  }

  /// By all threads, between two steps: the first one decides about sleep and search. False when
  /// the motion has diverged.
  bool between_steps(int rank, long step) {
    const bool review_due = world_.sleep.on && step > 0 && step % kReviewEvery == 0;
    const bool search_due = sweep_.moved() || search_.skin().is_too_large(step);
    if (!search_due && !review_due) return true;
    team_.meet();  // all have read the flags
    if (rank == 0) {
      world_.steps = step;
      diverged_ = first_diverged() >= 0;
      if (!diverged_ && review_due) review_.run();
      if (!diverged_ && (search_due || world_.search_needed)) search(search_due);
      sweep_.clear_moved();
    }
    team_.meet();
    return !diverged_;
  }

  /// Grains added since the last step get the acceleration of where they stand, so that their first
  /// step is as accurate as any other. The contacts' memories stay as they are.
  void start_new_grains() {
    const auto pairs = world_.contacts.pairs;
    const auto walls = world_.contacts.walls;
    const auto applied =
        world_.around.applied_at(static_cast<double>(world_.steps) * world_.time_step);
    team_.run([&](int rank) {
      sweep_.incoming(rank, 0);
      team_.meet();
      sweep_.template run<SweepKind::start>(rank, applied, 0, first_new_);
    });
    world_.contacts.pairs = pairs;
    world_.contacts.walls = walls;
    first_new_ = world_.grains.size();
  }

  /// The first body that moves too far in a step or is nowhere; -1: none.
  int first_diverged() const {
    for (int i = 0; i < world_.awake; ++i) {
      const auto& b = world_.grains.bodies[i];
      const double move = length_of(b.velocity) * world_.time_step;
      if (!(move <= kMaxMoveShare * b.radius) || !is_finite(b)) return i;
    }
    return -1;
  }

  /// Of place, speed and spin.
  template <class Body>
  static bool is_finite(const Body& b) {
    return b.position.allFinite() && std::isfinite(length_of(b.velocity)) &&
           std::isfinite(size_of(b.spin));
  }

  [[noreturn]] void report_divergence() const {
    const int i = first_diverged();
    if (i < 0) throw ComputationFailed("diverged");
    std::string place;
    for (const double x : world_.margins[i].position) {
      place += fmt::format("{}{:.4g}", place.empty() ? "" : ", ", x);
    }
    if (!is_finite(world_.grains.bodies[i])) {
      throw ComputationFailed(fmt::format(
          "diverged at t = {:.6g} s (step {}): grain {} last seen near ({}) m has a place, speed "
          "or "
          "spin that is not a finite number; lower motion.time_step (now {:.3g} s), damping or "
          "stiffness, or give grains of a usual size",
          time(), steps(), world_.grains.ids[i], place, world_.time_step));
    }
    throw ComputationFailed(fmt::format(
        "diverged at t = {:.6g} s (step {}): grain {} last seen near ({}) m at {:.3g} m/s moves "
        "more than half its radius in a step; lower motion.time_step (now {:.3g} s) or the load",
        time(), steps(), world_.grains.ids[i], place, length_of(world_.grains.bodies[i].velocity),
        world_.time_step));
  }

  State world_;
  Materials materials_;
  Search<State> search_;
  Review<State> review_;
  Sweep<State> sweep_;
  ThreadTeam team_;
  int free_ = 0;                // grains that are not fixed
  std::int64_t first_new_ = 0;  // ids from here on have not been started yet
  std::atomic<bool> diverged_{false};
};

}  // namespace grainfield::dem
