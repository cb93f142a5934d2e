// The engine: a world, and the parts that work on it, put together for one shape, law and
// integrator.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dem/checkpoint/checkpoint.h"
#include "dem/engine/add_forces.h"
#include "dem/engine/added_checkpoint.h"
#include "dem/engine/added_forces.h"
#include "dem/engine/cell_checks.h"
#include "dem/engine/engine.h"
#include "dem/engine/report.h"
#include "dem/engine/review.h"
#include "dem/engine/search.h"
#include "dem/engine/sweep.h"
#include "dem/engine/thread_team.h"
#include "dem/engine/turning.h"
#include "dem/engine/wall_steps.h"
#include "dem/engine/world.h"
#include "dem/engine/world_checkpoint.h"
#include "dem/shapes/polygon.h"
#include "dem/shapes/solid.h"
#include "dem/shared/computation_failed.h"

namespace grainfield::dem {

template <class Shape, class Law, class Integrator>
class EngineLoop final : public Engine, public TakesAddedForces {
 public:
  using State = World<Shape, Law, Integrator>;
  static constexpr int dim = Shape::dim;

  /// `integrator`: its word. Throws std::invalid_argument for materials that do not fit.
  EngineLoop(const EngineSettings& settings, const Rules<Law>& rules, const char* integrator)
      : world_(world_of(settings, rules, integrator)),
        materials_(settings),
        team_(settings.threads),
        search_(world_, settings.skin, team_),
        review_(world_, search_),
        sweep_(world_),
        add_forces_(world_),
        wall_steps_(world_) {
    check_rest_in_flow(world_.cell.flows(), false, settings.sleep.on);
  }

  std::int64_t add(const NewGrain& g) override {
    auto& grains = world_.grains;
    const int i = grains.size();
    const int kind = material_index(materials_, "grain", g.material);
    world_.acting.add_grain(kind);
    check_rest_in_flow(world_.cell.flows(), g.fixed, false);
    const ShapeInput shape{g.radius, g.outline, g.axes, g.exponents};
    const double radius = reach_of(shape);
    if (!holds(world_.cell, radius)) refuse_small_cell(world_.cell.shortest(), radius);
    largest_ = std::max(largest_, radius);
    const Solid<dim> solid = grains.shapes.add(shape);
    typename State::Body b;
    b.position = in_space<dim>({g.x, g.y, g.z});
    b.radius = solid.radius;
    Inertia<dim> inertia{g.density * solid.volume, g.density * solid.moments, solid.volume};
    if (g.mass > 0) inertia.mass = g.mass;
    read_moments(g, inertia);
    if (!g.fixed) {
      b.velocity = in_space<dim>({g.vx, g.vy, g.vz});
      b.inverse_mass = 1 / inertia.mass;
      if (g.rotates) read_spin(g, inertia, b);
      ++free_;
    }
    typename Integrator::Memory memory;
    memory.rotation = read_rotation(g, inertia);
    grains.bodies.push_back(b);
    grains.memory.push_back(memory);
    grains.inertias.push_back(inertia);
    grains.ids.push_back(i);
    grains.kinds.push_back(static_cast<std::uint8_t>(kind));
    if (world_.cell.is_periodic()) {
      auto& image = grains.images.emplace_back();
      std::copy_n(g.image.begin(), dim, image.begin());
      grains.cell_work.push_back(0);
    }
    world_.sleepers.add(b.position, memory.rotation, world_.steps, g.fixed && world_.sleep.on);
    grains.shapes.place(i, b, memory.rotation);
    if (world_.balance.on && !g.fixed) {
      world_.balance.brought_motion += Report(world_).kinetic_energy(i);
      world_.balance.brought_height += Report(world_).potential_energy(i);
    }
    world_.search_needed = true;
    return i;
  }

  void add_wall(const Wall& wall, const std::string& material) override {
    check_wall(world_.cell.told(), wall, dim);
    check_wall_motion(world_.cell.told(), wall, {wall.velocity, wall.angular_velocity});
    const int kind = material.empty() ? -1 : material_index(materials_, wall.name, material);
    if (!State::Shape::central && wall.shape != "plane") {
      throw std::invalid_argument(
          fmt::format("wall {}: shape: found \"{}\", allowed for {}: plane", wall.name, wall.shape,
                      State::Shape::outlines ? "polygons" : "superellipsoids"));
    }
    auto surface = surface_of<dim>(wall);
    for (int slot = 0; slot < surface->slots(); ++slot) {
      world_.acting.add_wall(kind, wall.friction);
    }
    Wall given = wall;
    given.material = material;
    world_.walls.add(given, std::move(surface));
    world_.search_needed = true;
    if (!wall.velocity.isZero(0) || !wall.angular_velocity.isZero(0)) {
      set_wall_motion(world_.walls.size() - 1, {wall.velocity, wall.angular_velocity});
    }
  }
  void set_wall_motion(int wall, const WallMotion& motion) override {
    const bool known = wall >= 0 && wall < world_.walls.size();
    if (known) check_wall_motion(world_.cell.told(), world_.walls.placed(wall), motion);
    const typename State::Vector before =
        known ? world_.walls.state(wall).centre : zero<typename State::Vector>();
    world_.walls.set_motion(wall, motion, time());
    wall_steps_.move_torques(wall, before - world_.walls.state(wall).centre);
    const auto [force, torque] =
        Report(world_).on_wall(wall, to_three(world_.walls.state(wall).centre));
    world_.walls.feel(wall, in_space<dim>(force), turning_in_space<dim>(torque));
    if (motion.servo) {
      Report(world_).visit_contacts([&](int i, const auto& pair, const auto&, bool at_wall,
                                        const auto&) {
        if (!at_wall || world_.walls.wall_of(pair.j) != wall) return;
        world_.walls.add_force(wall, State::Vector::Zero(), zero<SpinOf<dim>>(),
                               wall_steps_.stiffness_at(i, pair.j), world_.grains.inertias[i].mass);
      });
    }
    wall_steps_.forget();
    world_.search_needed = true;
    world_.wake_all();
  }
  std::vector<Wall> walls() const override { return Report(world_).walls(); }
  void apply(const AppliedForce& force, const std::vector<std::int64_t>& beside) override {
    world_.around.applied = force;
    world_.beside = beside;
    std::sort(world_.beside.begin(), world_.beside.end());
    world_.wake_all();
  }
  void set_background_damping(double rate) override { world_.around.drag = rate; }
  void set_gravity(double gx, double gy, double gz) override {
    const double before = world_.balance.on ? Report(world_).potential_energy() : 0;
    world_.around.gravity = in_space<dim>({gx, gy, gz});
    if (world_.balance.on) {
      world_.balance.brought_height += Report(world_).potential_energy() - before;
    }
    world_.wake_all();
  }
  void set_velocity_gradient(const Eigen::Matrix3d& gradient) override {
    if (world_.added.on() && !gradient.isZero(0)) refuse_flow_with_added_forces();
    Cell<3> cell = world_.cell.told();
    cell.velocity_gradient = gradient;
    check_cell(cell, dim, world_.time_step);
    const bool fixed = free_ < world_.grains.size();
    check_rest_in_flow(!gradient.isZero(0), fixed, world_.sleep.on);
    const bool flowed = world_.cell.flows();
    const typename MovingCell<dim>::Matrix l = gradient.template topLeftCorner<dim, dim>();
    for (auto& b : world_.grains.bodies) {
      if (b.inverse_mass == 0) continue;
      b.velocity += world_.cell.change_of_flow(l, b.position);
    }
    world_.cell.set_gradient(l);
    // Margins are counted in another way with a flow than without; within a flow by the edges.
    if (flowed != world_.cell.flows()) world_.search_needed = true;
  }
  Cell<3> cell() const override { return world_.cell.told(); }
  void set_sleep(bool on) override {
    if (world_.added.on() && on) refuse_sleep_with_added_forces();
    check_rest_in_flow(world_.cell.flows(), false, on);
    world_.sleep.on = on;
    world_.wake_all();
  }

  void add_force(std::shared_ptr<AddedForce> force) override {
    if (world_.sleep.on) refuse_sleep_with_added_forces();
    if (world_.cell.flows()) refuse_flow_with_added_forces();
    auto& sources = world_.added.sources;
    std::erase(world_.added.former, force->name());
    world_.added.changed = true;
    for (auto& source : sources) {
      if (source.force->name() == force->name()) return source.force.swap(force);
    }
    sources.push_back({std::move(force), {}, {}});
  }
  void remove_force(const std::string& name) override {
    auto& sources = world_.added.sources;
    const auto has_name = [&](const auto& source) { return source.force->name() == name; };
    if (std::erase_if(sources, has_name) == 0) {
      throw std::invalid_argument(fmt::format("found no added force \"{}\", allowed: {}", name,
                                              sources.empty() ? "none" : world_.added.names()));
    }
    world_.added.changed = true;
    mark_former_forces({name});
    add_forces_.sum_up();
  }
  std::vector<std::string> added_forces() const override {
    std::vector<std::string> names;
    for (const auto& source : world_.added.sources) names.push_back(source.force->name());
    return names;
  }
  void mark_former_forces(const std::vector<std::string>& names) override {
    auto& former = world_.added.former;
    for (const std::string& name : names) {
      if (std::find(former.begin(), former.end(), name) == former.end()) former.push_back(name);
    }
  }

  void step(long n) override {
    if (n <= 0) return;
    wall_steps_.check_speeds();
    if (world_.search_needed) search(false);
    const long start = world_.steps;
    sweep_.clear_moved();
    const bool adds = world_.added.on();
    if (first_new_ < world_.grains.size() || world_.added.changed) {
      if (adds) add_forces_.ask(start, true);
      if (world_.added.changed) first_new_ = 0;  // the first half kick is theirs, too
      start_new_grains();
      world_.added.changed = false;
    }
    if (wall_steps_.leave_margins()) sweep_.ask_for_search();
    const bool flows = world_.cell.flows();
    if (flows) world_.cell.look_ahead();
    std::exception_ptr failure;  // of a force of the caller's own; then this step is the last
    team_.run([&](int rank) {
      sweep_.begin_block(rank);
      for (long s = 0; s < n; ++s) {
        team_.barrier();
        if (rank == 0) {
          if (s > 0) wall_steps_.feel();
          wall_steps_.advance(start + s);
        }
        if (flows) {
          if (rank == 0) world_.cell.advance();
          team_.barrier();
        }
        if (!between_steps(rank, start + s)) return;
        if (adds) [[unlikely]] {
          team_.alone(rank, [&] {
            try {
              add_forces_.ask(start + s + 1, false);
            } catch (...) {
              failure = std::current_exception();
              n = s + 1;
            }
          });
        }
        const bool moves_on = s + 1 < n;
        if (moves_on) {
          sweep_.template crossing<SweepKind::move_on>(rank, world_.time_step);
        } else {
          sweep_.template crossing<SweepKind::last>(rank, world_.time_step);
        }
        team_.barrier();
        if (rank == 0 && wall_steps_.leave_margins()) sweep_.ask_for_search();
        const auto applied =
            world_.around.applied_at(static_cast<double>(start + s + 1) * world_.time_step);
        if (moves_on) {
          sweep_.template run<SweepKind::move_on>(rank, applied, world_.time_step);
        } else {
          sweep_.template run<SweepKind::last>(rank, applied, world_.time_step);
        }
      }
    });
    if (!diverged_) {
      if (flows) world_.cell.finish();
      wall_steps_.feel();
      world_.steps = start + n;
      diverged_ = has_diverged();  // a grain that only spins is not searched for
    }
    if (failure) std::rethrow_exception(failure);
    if (diverged_) {
      world_.contacts.forget_forces();
      report_divergence();
    }
  }

  double time() const override { return world_.time(); }
  long steps() const override { return world_.steps; }
  int grains() const override { return free_; }
  double time_step() const override { return world_.time_step; }
  Diagnostics measure() const override { return Report(world_).measure(); }
  Motion motion() const override { return Report(world_).motion(); }
  Snapshot snapshot() const override { return Report(world_).snapshot(); }
  GrainArrays arrays() const override {
    GrainArrays out;
    const auto& bodies = world_.grains.bodies;
    out.count = world_.grains.size();
    out.dim = dim;
    out.stride = sizeof(typename State::Body);
    if (bodies.empty()) return out;
    out.position = bodies.front().position.data();
    out.velocity = bodies.front().velocity.data();
    if constexpr (dim == 2)
      out.spin = &bodies.front().spin;
    else
      out.spin = bodies.front().spin.data();
    out.radius = &bodies.front().radius;
    out.ids = world_.grains.ids.data();
    return out;
  }
  CellStress cell_stress() const override { return Report(world_).cell_stress(); }

  /// As frozen contacts without force: the next search hands their memories on.
  void remember(const std::vector<Contact>& contacts) override {
    const std::vector<int> index = world_.grains.index();
    std::int64_t last_i = -1, last_j = -1;
    int again = 0;
    for (const Contact& c : contacts) {
      typename State::Frozen frozen;
      int other = c.j < 0 ? 0 : index[c.j];
      if (c.j < 0) {  // of several contacts with one wall each has a slot, in their order
        const int wall = static_cast<int>(-1 - c.j);
        again = c.i == last_i && c.j == last_j ? again + 1 : 0;
        last_i = c.i;
        last_j = c.j;
        if (again >= world_.walls.slots_of(wall)) continue;  // facets of another program
        other = world_.walls.first_slot(wall) + again;
        frozen.key = wall_key(c.i, other);
      } else {
        frozen.key = pair_key(c.i, c.j);
      }
      last_i = c.i;
      last_j = c.j;
      typename State::Memory memory;
      read_spring(c, memory.spring);
      Report(world_).take_up(index[c.i], other, c.j < 0, memory);
      const bool turned = c.j >= 0 && c.j < c.i;
      frozen.memory = seen_from(memory, turned);
      world_.sleepers.frozen.keep(frozen);
      if (!world_.rolling.on) continue;
      RollingMemory<dim> rolling;
      read_rolling(c, rolling);
      if (!rolling.empty()) world_.rolling.told.push_back({frozen.key, seen_from(rolling, turned)});
    }
    world_.rolling.sort();
    world_.search_needed = true;
  }

  std::string checkpoint() const override {
    CheckpointWriter w;
    if (world_.added.on() || !world_.added.former.empty()) write_added(world_.added, w);
    w.put(free_);
    w.put(first_new_);
    write_world(world_, search_, w);
    return w.bytes();
  }
  void restore(const std::string& checkpoint) override {
    CheckpointReader r(checkpoint);
    if (holds_added(checkpoint)) read_added(world_.added, r);
    r.get(free_);
    r.get(first_new_);
    read_world(world_, search_, r);
    r.finish();
    for (const auto& source : world_.added.sources) {
      r.require(source.loads.empty() || source.loads.size() == world_.grains.ids.size());
    }
    add_forces_.sum_up();
    for (const int kind : world_.grains.kinds) world_.acting.add_grain(kind);
    for (const auto& b : world_.grains.bodies) largest_ = std::max(largest_, b.radius);
    sweep_.reset();
    wall_steps_.forget();
  }

 private:
  static State world_of(const EngineSettings& settings, const Rules<Law>& rules,
                        const char* integrator) {
    State world;
    world.acting = typename State::Acting(rules);
    world.integrator = integrator;
    world.sleep = settings.sleep;
    world.balance.on = settings.energy_balance;
    world.rolling.on = settings.resist_rolling();
    world.local_damping = settings.local_damping;
    world.time_step = settings.time_step;
    world.cell = MovingCell<dim>(settings.cell, settings.time_step);
    world.around.gravity =
        in_space<dim>({settings.gravity_x, settings.gravity_y, settings.gravity_z});
    return world;
  }

  /// From the centroid to the farthest point, m.
  static double reach_of(const ShapeInput& shape) {
    if constexpr (requires { Shape::reach(shape); }) return Shape::reach(shape);
    return shape.outline.empty() ? shape.radius : circumradius_of(shape.outline);
  }

  void search(bool by_motion) {
    search_.run(by_motion);
    sweep_.reset();
  }

  /// By all threads, between two steps: the first one decides about sleep and search. False when
  /// the motion has diverged.
  bool between_steps(int rank, long step) {
    const bool review_due = world_.sleep.on && step > 0 && step % kReviewEvery == 0;
    const bool search_due =
        sweep_.moved() || search_.skin().is_too_large(step) || cell_may_be_too_small();
    if (!search_due && !review_due) return true;
    team_.alone(rank, [&] {  // once all have read the flags
      world_.steps = step;
      diverged_ = has_diverged();
      if (!diverged_ && review_due) review_.run();
      if (!diverged_ && (search_due || world_.search_needed)) search(search_due);
      if (!diverged_ && !holds(world_.cell, largest_)) diverged_ = true;
      sweep_.clear_moved();
    });
    return !diverged_;
  }

  /// Grains added since the last step get the acceleration of where they stand, so that their first
  /// step is as accurate as any other. The contacts' memories stay as they are.
  void start_new_grains() {
    const auto pairs = world_.contacts.pairs;
    const auto walls = world_.contacts.walls;
    const auto wall_forces = world_.contacts.wall_forces;
    const auto wall_normals = world_.contacts.wall_normals;
    const auto rolling = world_.rolling;
    const auto applied =
        world_.around.applied_at(static_cast<double>(world_.steps) * world_.time_step);
    team_.run([&](int rank) {
      sweep_.template crossing<SweepKind::start>(rank, 0);
      team_.barrier();
      sweep_.template run<SweepKind::start>(rank, applied, 0, first_new_);
    });
    world_.contacts.pairs = pairs;
    world_.contacts.walls = walls;
    world_.contacts.wall_forces = wall_forces;
    world_.contacts.wall_normals = wall_normals;
    world_.rolling = rolling;
    first_new_ = world_.grains.size();
  }

  /// By the flow since the last search.
  bool cell_may_be_too_small() const {
    const auto& cell = world_.cell;
    return cell.flows() && !(cell.shortest() * (1 - cell.strain()) >= kLeastCell * largest_);
  }
  bool has_diverged() const { return sweep_.crossed() || first_diverged() >= 0; }

  /// The first body that moves too far in a step or is nowhere; -1: none.
  int first_diverged() const {
    for (int i = 0; i < world_.awake; ++i) {
      const auto& b = world_.grains.bodies[i];
      const double move = length_of(world_.fluctuation(i)) * world_.time_step;
      if (!(move <= kMaxMoveShare * b.radius) || !is_finite(b)) return i;
    }
    return -1;
  }

  /// Whether place, speed and spin are finite.
  template <class Body>
  static bool is_finite(const Body& b) {
    return b.position.allFinite() && std::isfinite(length_of(b.velocity)) &&
           std::isfinite(size_of(b.spin));
  }

  [[noreturn]] void report_divergence() const {
    if (!holds(world_.cell, largest_)) {
      report_small_cell(world_.cell.shortest(), largest_, time(), steps());
    }
    const int i = first_diverged();
    if (i < 0) {
      throw ComputationFailed(fmt::format(
          "diverged at t = {:.6g} s (step {}): a wall goes through grains by more than half a "
          "radius a step; lower its speed or motion.time_step (now {:.3g} s)",
          time(), steps(), world_.time_step));
    }
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
        time(), steps(), world_.grains.ids[i], place, length_of(world_.fluctuation(i)),
        world_.time_step));
  }

  State world_;
  Materials materials_;
  ThreadTeam team_;
  Search<State> search_;
  Review<State> review_;
  Sweep<State> sweep_;
  AddForces<State> add_forces_;
  WallSteps<State> wall_steps_;
  int free_ = 0;                // grains that are not fixed
  double largest_ = 0;          // radius, m
  std::int64_t first_new_ = 0;  // ids from here on have not been started yet
  std::atomic<bool> diverged_{false};
};

}  // namespace grainfield::dem
