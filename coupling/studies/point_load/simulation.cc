// A layer is built, comes to rest, and one of its top grains is loaded (Roul ch. 5):
//   deposit (layered packings) -> rest -> snapshot "unloaded" -> load -> hold -> snapshot "loaded".
#include "coupling/studies/point_load/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "coupling/studies/point_load/layer_figures.h"
#include "coupling/studies/point_load/load_by_newton.h"
#include "coupling/studies/point_load/simulation_space.h"
#include "dem/grains/packing.h"
#include "dem/run/fingerprint.h"
#include "dem/run/phases.h"

namespace grainfield::dem {
namespace {

// Rest is judged every so many steps, counted within a phase: cheap beside the steps themselves.
constexpr long kCheckEvery = 200;
// A dropped row counts as settled when the mean kinetic energy per grain is below this share of
// m g r of a mean grain: then nothing rises by more than a hundredth of a radius any more.
constexpr double kSettledShare = 0.01;
// ... but is given at least the time of its fall and at most this, s.
constexpr double kMaxSettleTime = 2.0;

enum class Phase : int { deposit, rest, load, hold, done };

class PointLoadRun final : public ArchivedRun {
 public:
  PointLoadRun(const PointLoadSetup& setup, std::uint64_t seed, int threads);

  void advance(long steps) override;
  bool done() const override { return phases_.done(); }
  Progress progress() const override;
  RunResult result() const override;

 private:
  Diagnostics loaded_state() const;
  void visit(Archive& archive) override;
  std::unique_ptr<Engine> empty_engine() const;
  void enter(Phase phase);
  void decide();
  void solve();
  AppliedForce load_on(const Snapshot& s) const;
  bool by_newton() const { return setup_.load.method == "newton"; }
  void drop_row();
  void add(const std::vector<NewGrain>& grains);
  std::string fingerprint() const override;
  Snapshot take_snapshot(const char* state) const;
  std::int64_t choose_loaded_grain(const Snapshot& snapshot) const;

  PointLoadSetup setup_;
  std::uint64_t seed_;
  Random random_;
  GrainSupply supply_;
  double width_ = 0;
  EngineSettings settings_;
  std::unique_ptr<Engine> engine_;
  Phases<Phase> phases_;
  int rows_dropped_ = 0;
  std::optional<Snapshot> unloaded_, loaded_;
  Reached reached_;  // by Newton's method
};

// In the order of Phase. Layered packings are built first, which takes a good part of the time.
std::vector<PhaseInfo> phases_of(const PackingSetup& packing) {
  const double built = packing.kind == "layered" ? 0.4 : 0, rested = 0.5 + 0.5 * built;
  const double loaded = rested + 0.4 * (1 - rested);
  return {{"deposit", false, 0, built},
          {"rest", true, built, rested},
          {"load", true, rested, loaded},
          {"hold", true, loaded, 1},
          {"done", true, 1, 1}};
}

const PackingSetup& checked(const PackingSetup& packing) {
  check_packing(packing);
  return packing;
}

PointLoadRun::PointLoadRun(const PointLoadSetup& setup, std::uint64_t seed, int threads)
    : setup_(setup),
      seed_(seed),
      random_(seed),
      supply_(checked(setup_.packing), random_),
      phases_(phases_of(setup_.packing)) {
  check_method("load.method", setup_.load.method, setup_.material, setup_.motion);
  const double density = setup_.material.density;
  width_ = layer_width(setup_.packing);
  settings_ = engine_settings(setup_.material, setup_.motion, supply_.extremes(density), threads,
                              setup_.packing.shape == "irregular");
  settings_.shape = setup_.packing.shape != "disk" ? ShapeKind::polygon : ShapeKind::disk;
  check_background_damping(setup_.rest, settings_.time_step);
  if (!by_newton()) {
    check_countable("load.ramp_time", setup_.load.ramp_time, settings_.time_step);
  }
  engine_ = empty_engine();
  add(floor_grains(setup_.packing, supply_, density, random_));
  if (setup_.packing.kind == "layered") {
    enter(Phase::deposit);
    drop_row();
  } else {
    add(lattice_grains(setup_.packing, density, random_));
    enter(Phase::rest);
  }
}

std::unique_ptr<Engine> PointLoadRun::empty_engine() const {
  std::unique_ptr<Engine> engine = make_engine(settings_);
  for (const Wall& wall : layer_walls(setup_.packing, setup_.material)) engine->add_wall(wall);
  return engine;
}

void PointLoadRun::add(const std::vector<NewGrain>& grains) {
  for (const NewGrain& g : grains) engine_->add(g);
}

void PointLoadRun::drop_row() {
  const double top = rows_dropped_ == 0 ? 0.0 : engine_->measure().height;
  add(row_of_grains(setup_.packing, supply_, setup_.material.density,
                    top + setup_.packing.drop_height, random_));
  ++rows_dropped_;
}

void PointLoadRun::enter(Phase phase) {
  phases_.enter(phase);
  engine_->set_background_damping(phases_.info().damped ? setup_.rest.background_damping : 0);
}

void PointLoadRun::advance(long steps) {
  while (steps > 0 && !done()) {
    if (phases_.now() == Phase::load && by_newton()) return solve();
    steps -= phases_.step(*engine_, steps, kCheckEvery);
    if (phases_.is_due(kCheckEvery)) decide();
  }
}

void PointLoadRun::decide() {
  const double in_phase = static_cast<double>(phases_.steps()) * engine_->time_step();
  switch (phases_.now()) {
    case Phase::deposit: {
      const Diagnostics d = engine_->measure();
      const double r = 0.5 * (smallest_radius(setup_.packing) + largest_radius(setup_.packing));
      const double mass = setup_.material.density * std::numbers::pi * r * r;
      const double fall =
          1.5 * std::sqrt(2 * (setup_.packing.drop_height + 2 * r) / setup_.material.gravity);
      const bool settled = d.kinetic_energy <=
                           kSettledShare * mass * setup_.material.gravity * r * engine_->grains();
      if (in_phase < fall || (!settled && in_phase < kMaxSettleTime)) return;
      if (surface_height(engine_->snapshot(), width_) >= setup_.packing.depth) {
        enter(Phase::rest);
      } else {
        drop_row();
        phases_.restart();
      }
      return;
    }
    case Phase::rest:
    case Phase::hold:
      if (const Diagnostics d = engine_->measure(); at_rest(d, setup_.rest)) {
        if (phases_.now() == Phase::hold) {
          loaded_ = take_snapshot("loaded");
          phases_.enter(Phase::done);
          return;
        }
        unloaded_ = take_snapshot("unloaded");
        enter(Phase::load);
        if (by_newton()) return;
        AppliedForce force = load_on(*unloaded_);
        force.start = engine_->time();
        force.ramp = setup_.load.ramp_time;
        engine_->apply(force);
      } else if (in_phase > setup_.rest.max_time) {
        fail_to_rest(d, setup_.rest,
                     phases_.now() == Phase::hold ? "after the load" : "before the load",
                     ", or lower load.force");
      }
      return;
    case Phase::load:
      if (in_phase >= setup_.load.ramp_time) enter(Phase::hold);
      return;
    case Phase::done:
      return;
  }
}

AppliedForce PointLoadRun::load_on(const Snapshot& s) const {
  AppliedForce force;
  force.id = choose_loaded_grain(s);
  force.fy = -setup_.load.force;
  return force;
}

// The load by Newton's method. Told to stop it leaves the run as it was.
void PointLoadRun::solve() {
  std::optional<LoadedLayer> done =
      load_by_newton(*unloaded_, settings_, setup_.load, load_on(*unloaded_), {}, watch_of("load"));
  if (!done) return;
  reached_ = done->reached;
  loaded_ = std::move(done->state);
  phases_.enter(Phase::done);
}

std::int64_t PointLoadRun::choose_loaded_grain(const Snapshot& s) const {
  const double x0 = (setup_.load.position - 0.5) * width_;
  std::int64_t best = -1;
  double height = -1;
  // The highest grain within a radius of the wanted place, or where there is none within more; ties
  // go to the nearer one.
  for (double reach = largest_radius(setup_.packing); best < 0; reach *= 2) {
    for (const Grain& g : s.grains) {
      if (g.fixed || std::fabs(g.position.x() - x0) > reach) continue;
      const double key = g.position.y() - 1e-3 * std::fabs(g.position.x() - x0);
      if (best < 0 || key > height) {
        best = g.id;
        height = key;
      }
    }
  }
  return best;
}

Snapshot PointLoadRun::take_snapshot(const char* state) const {
  return named_snapshot(*engine_, state, seed_,
                        {{"packing", setup_.packing.kind}, {"floor", setup_.packing.floor}});
}

Progress PointLoadRun::progress() const {
  const Diagnostics d = engine_->measure();
  Progress p = progress_of(*engine_, d);
  const double in_phase = static_cast<double>(phases_.steps()) * engine_->time_step();
  p.phase = phases_.info().name;
  switch (phases_.now()) {
    case Phase::deposit:
      p.phase = fmt::format("deposit row {}", rows_dropped_);
      p.fraction = phases_.fraction((d.height - setup_.packing.drop_height) / setup_.packing.depth);
      break;
    case Phase::rest:
    case Phase::hold:
      p.fraction = phases_.fraction(rest_progress(d, setup_.rest));
      break;
    case Phase::load:
      p.fraction = phases_.fraction(in_phase / std::max(setup_.load.ramp_time, 1e-300));
      break;
    case Phase::done:
      p.fraction = 1;
      break;
  }
  return p;
}

std::string PointLoadRun::fingerprint() const {
  return fmt::format("point load {} {} {}", fingerprint_of(setup_), settings_.time_step, seed_);
}

void PointLoadRun::visit(Archive& archive) {
  phases_.visit(archive);
  archive(rows_dropped_);
  archive(random_);
  long taken = supply_.taken();
  archive(taken);
  supply_.set_taken(taken);
  archive(reached_);
  archive.engine(engine_, [this] { return empty_engine(); });
  archive.snapshot(unloaded_, "unloaded");
  archive.snapshot(loaded_, "loaded");
  archive.require((phases_.now() < Phase::load || unloaded_) && (!done() || loaded_));
}

/// Of the state that the run ends with.
Diagnostics PointLoadRun::loaded_state() const {
  return by_newton() ? diagnostics_of(*loaded_, settings_) : engine_->measure();
}

RunResult PointLoadRun::result() const {
  RunResult out;
  if (!unloaded_ || !loaded_) return out;
  out.snapshots = {{"unloaded", *unloaded_}, {"loaded", *loaded_}};
  auto& f = out.figures;
  add_engine_figures(*engine_, loaded_state(), f);

  add_layer_figures(*unloaded_, *loaded_, surface_height(*unloaded_, width_), width_, width_, f);
  f["load.force"] = setup_.load.force;

  add_reached("load", reached_, f);
  add_contact_changes(*unloaded_, *loaded_, f);
  return out;
}

}  // namespace

std::unique_ptr<Run> make_point_load_run(const PointLoadSetup& setup, std::uint64_t seed,
                                         int threads) {
  if (setup.packing.dim == 3) return make_space_load_run(setup, seed, threads);
  return std::make_unique<PointLoadRun>(setup, seed, threads);
}

}  // namespace grainfield::dem
