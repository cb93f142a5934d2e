// A layer of spheres settles, comes to rest, and one of its top grains is loaded:
//   settle (spheres placed at random) -> rest -> snapshot "unloaded" -> (probe) -> load -> hold ->
//   "loaded".
#include "coupling/studies/point_load/simulation_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "coupling/studies/point_load/layer_figures.h"
#include "coupling/studies/point_load/layer_probe.h"
#include "coupling/studies/point_load/load_by_newton.h"
#include "coupling/studies/point_load/simulation.h"
#include "dem/grains/layer_3d.h"
#include "dem/grains/superellipsoid_family.h"
#include "dem/run/fingerprint.h"
#include "dem/run/phases.h"
#include "dem/run/softness.h"
#include "dem/snapshot/images.h"

namespace grainfield::dem {
namespace {

// Rest is judged every so many steps, counted within a phase: cheap beside the steps themselves.
constexpr long kCheckEvery = 200;
// Spheres have settled when the mean kinetic energy of one is below this share of m g r: then
// nothing rises by more than a hundredth of a radius any more.
constexpr double kSettledShare = 0.01;

enum class Phase : int { settle, rest, probe, load, hold, done };

// In the order of Phase.
std::vector<PhaseInfo> phases_of(const PointLoadSetup& s) {
  const double settled = s.packing.kind == "random" ? 0.2 : 0, rested = 0.5 + 0.2 * settled;
  const double probed = s.load.probe_strain > 0 ? rested + 0.4 * (1 - rested) : rested;
  const double loaded = probed + 0.4 * (1 - probed);
  return {{"settle", false, 0, settled},   {"rest", true, settled, rested},
          {"probe", true, rested, probed}, {"load", true, probed, loaded},
          {"hold", true, loaded, 1},       {"done", true, 1, 1}};
}

class SpaceLoadRun final : public ArchivedRun {
 public:
  SpaceLoadRun(const PointLoadSetup& setup, std::uint64_t seed, int threads);

  void advance(long steps) override;
  bool done() const override { return phases_.done(); }
  Progress progress() const override;
  RunResult result() const override;

 private:
  void visit(Archive& archive) override;
  std::unique_ptr<Engine> empty_engine() const;
  void enter(Phase phase);
  void decide();
  bool by_newton() const { return setup_.load.method == "newton"; }
  void solve();
  void probe();
  void begin_load();
  bool has_settled() const;
  void decide_rest();
  double in_phase() const { return static_cast<double>(phases_.steps()) * engine_->time_step(); }
  std::string fingerprint() const override;
  Snapshot take_snapshot(const char* state) const;
  struct SharedForce {
    AppliedForce force;                ///< on each
    std::vector<std::int64_t> beside;  ///< the others that carry it
  };
  SharedForce load_on(const Snapshot& snapshot) const;
  std::int64_t choose_loaded_grain(const Snapshot& snapshot) const;
  std::vector<std::int64_t> others_loaded(const Snapshot& snapshot, std::int64_t first) const;

  PointLoadSetup setup_;
  std::uint64_t seed_;
  EngineSettings settings_;
  std::unique_ptr<Engine> engine_;
  Phases<Phase> phases_;
  std::optional<Snapshot> unloaded_, loaded_;
  std::optional<LayerProber> prober_;  // settled; made anew after a resume
  int probed_ = 0;                     // probes that are done
  Reached reached_;                    // by Newton's method
};

SpaceLoadRun::SpaceLoadRun(const PointLoadSetup& setup, std::uint64_t seed, int threads)
    : setup_(setup), seed_(seed), phases_(phases_of(setup)) {
  check_packing(setup.packing);
  const bool angular = is_angular(setup.packing);
  if (!angular) settings_ = space_load_settings(setup, threads);
  Random random(seed);
  const double density = setup_.material.density;
  const std::vector<NewGrain> floor = floor_3d(setup_.packing, density, random);
  const std::vector<NewGrain> grains = grains_3d(setup_.packing, density, random);
  std::vector<ShapedGrain> shapes;  // of superellipsoids, and of the spheres of their floor
  if (angular) {
    for (const auto* all : {&floor, &grains}) {
      for (const NewGrain& g : *all) {
        shapes.emplace_back();
        shapes.back().axes = g.axes;
        shapes.back().exponents = g.exponents;
      }
    }
  }
  if (angular) settings_ = space_load_settings(setup, threads, shapes);
  engine_ = empty_engine();
  for (const NewGrain& g : floor) engine_->add(g);
  for (const NewGrain& g : grains) engine_->add(g);
  enter(setup_.packing.kind == "random" ? Phase::settle : Phase::rest);
}

std::unique_ptr<Engine> SpaceLoadRun::empty_engine() const {
  std::unique_ptr<Engine> engine = make_engine(settings_);
  for (const Wall& wall : walls_3d(setup_.packing, setup_.material)) engine->add_wall(wall);
  return engine;
}

void SpaceLoadRun::enter(Phase phase) {
  phases_.enter(phase);
  engine_->set_background_damping(phases_.info().damped ? setup_.rest.background_damping : 0);
}

void SpaceLoadRun::advance(long steps) {
  while (steps > 0 && !done()) {
    if (phases_.now() == Phase::probe) return probe();
    if (phases_.now() == Phase::load && by_newton()) return solve();
    steps -= phases_.step(*engine_, steps, kCheckEvery);
    if (phases_.is_due(kCheckEvery)) decide();
  }
}

bool SpaceLoadRun::has_settled() const {
  const PackingSetup& p = setup_.packing;
  const double g = setup_.material.gravity;
  if (in_phase() < std::sqrt(2 * loose_height(p) / g)) return false;
  const double mass = setup_.material.density * mean_sphere_volume(p);
  return engine_->motion().kinetic_energy <=
         kSettledShare * mass * g * mean_sphere_radius(p) * engine_->grains();
}

void SpaceLoadRun::decide() {
  switch (phases_.now()) {
    case Phase::settle:
      if (has_settled()) {
        enter(Phase::rest);
      } else if (in_phase() > setup_.rest.max_time) {
        fail_to_rest(engine_->measure(), setup_.rest, "while the spheres settle", "");
      }
      return;
    case Phase::rest:
    case Phase::hold:
      return decide_rest();
    case Phase::load:
      if (in_phase() >= setup_.load.ramp_time) enter(Phase::hold);
      return;
    case Phase::probe:
    case Phase::done:
      return;
  }
}

void SpaceLoadRun::decide_rest() {
  const bool holds = phases_.now() == Phase::hold;
  const Diagnostics d = engine_->measure();
  if (!at_rest(d, setup_.rest)) {
    if (in_phase() > setup_.rest.max_time) {
      fail_to_rest(d, setup_.rest, holds ? "after the load" : "before the load",
                   ", or lower load.weights or load.force");
    }
    return;
  }
  if (holds) {
    loaded_ = take_snapshot("loaded");
    phases_.enter(Phase::done);
    return;
  }
  unloaded_ = take_snapshot("unloaded");
  if (setup_.load.probe_strain > 0) {
    enter(Phase::probe);
  } else {
    begin_load();
  }
}

// The rest before the probes, one more probe, or the load. Told to stop it leaves the run as it
// was.
void SpaceLoadRun::probe() {
  if (probed_ == LayerProber::count()) {
    prober_.reset();
    return begin_load();
  }
  if (!prober_) {
    LayerProber prober(*unloaded_, settings_, surface_3d(*unloaded_, setup_.packing),
                       setup_.load.probe_strain);
    if (prober.settle(watch_of("probe"))) prober_.emplace(std::move(prober));
    return;
  }
  const auto outcome = prober_->probe(probed_, watch_of("probe"));
  if (!outcome) return;
  StateProbes all = probes_of(*unloaded_, kProbedLayer);
  all.stress = prober_->stress_before();
  add_outcome(all, LayerProber::direction(probed_), probed_, *outcome);
  put_probes(all, *unloaded_);
  ++probed_;
}

void SpaceLoadRun::begin_load() {
  enter(Phase::load);
  if (by_newton()) return;
  SharedForce load = load_on(*unloaded_);
  load.force.start = engine_->time();
  load.force.ramp = setup_.load.ramp_time;
  engine_->apply(load.force, load.beside);
}

SpaceLoadRun::SharedForce SpaceLoadRun::load_on(const Snapshot& s) const {
  SharedForce out;
  out.force.id = choose_loaded_grain(s);
  out.beside = others_loaded(s, out.force.id);
  out.force.fz = -force_of_load(setup_) / static_cast<double>(1 + out.beside.size());
  return out;
}

// The load by Newton's method. Told to stop it leaves the run as it was.
void SpaceLoadRun::solve() {
  const SharedForce load = load_on(*unloaded_);
  std::optional<LoadedLayer> done =
      load_by_newton(*unloaded_, settings_, setup_.load, load.force, load.beside, watch_of("load"));
  if (!done) return;
  reached_ = done->reached;
  loaded_ = std::move(done->state);
  phases_.enter(Phase::done);
}

// The grains within load.radius of that one whose centres no higher grain covers.
std::vector<std::int64_t> SpaceLoadRun::others_loaded(const Snapshot& s, std::int64_t first) const {
  const auto apart = [&s](const Grain& a, const Grain& b) {
    Vec3 way = a.position - b.position;
    way.z() = 0;
    way += shift_to(s.cell, nearest_image(s.cell, way));
    return way.head<2>().norm();
  };
  const Grain& middle = s.grains[static_cast<std::size_t>(first)];
  std::vector<std::int64_t> out;
  for (const Grain& g : s.grains) {
    if (g.fixed || g.id == first || apart(g, middle) > setup_.load.radius) continue;
    const bool covered = std::any_of(s.grains.begin(), s.grains.end(), [&](const Grain& other) {
      return other.position.z() > g.position.z() && apart(other, g) < other.radius;
    });
    if (!covered) out.push_back(g.id);
  }
  return out;
}

// The highest grain within two diameters of the wanted place, or where there is none within more:
// within a radius, as in the plane, there may be a pit alone, whose highest grain lies deep below
// the surface. Ties go to the nearer one.
std::int64_t SpaceLoadRun::choose_loaded_grain(const Snapshot& s) const {
  const auto sides = layer_sides(setup_.packing);
  const Vec3 wanted((setup_.load.position - 0.5) * sides[0],
                    (setup_.load.position_y - 0.5) * sides[1], 0);
  std::int64_t best = -1;
  double height = 0;
  for (double reach = 4 * largest_radius(setup_.packing); best < 0; reach *= 2) {
    for (const Grain& g : s.grains) {
      Vec3 way = g.position - wanted;
      way.z() = 0;
      way += shift_to(s.cell, nearest_image(s.cell, way));
      const double apart = way.head<2>().norm();
      if (g.fixed || apart > reach) continue;
      const double key = g.position.z() - 1e-3 * apart;
      if (best < 0 || key > height) {
        best = g.id;
        height = key;
      }
    }
  }
  return best;
}

Snapshot SpaceLoadRun::take_snapshot(const char* state) const {
  return named_snapshot(*engine_, state, seed_,
                        {{"packing", setup_.packing.kind}, {"floor", setup_.packing.floor}});
}

Progress SpaceLoadRun::progress() const {
  const Diagnostics d = engine_->measure();
  Progress p = progress_of(*engine_, d);
  p.phase = phases_.info().name;
  double share = 1;
  switch (phases_.now()) {
    case Phase::settle:
      share =
          0.5 * in_phase() / std::sqrt(2 * loose_height(setup_.packing) / setup_.material.gravity);
      break;
    case Phase::rest:
    case Phase::hold:
      share = rest_progress(d, setup_.rest);
      break;
    case Phase::load:
      share = in_phase() / std::max(setup_.load.ramp_time, 1e-300);
      break;
    case Phase::probe:
      share = static_cast<double>(probed_) / LayerProber::count();
      break;
    case Phase::done:
      break;
  }
  p.fraction = done() ? 1 : phases_.fraction(share);
  return p;
}

std::string SpaceLoadRun::fingerprint() const {
  return fmt::format("point load {} {} {}", fingerprint_of(setup_), settings_.time_step, seed_);
}

void SpaceLoadRun::visit(Archive& archive) {
  phases_.visit(archive);
  archive(probed_);
  archive.require(probed_ >= 0 && probed_ <= LayerProber::count());
  archive(reached_);
  archive.engine(engine_, [this] { return empty_engine(); });
  archive.snapshot(unloaded_, "unloaded");
  archive.snapshot(loaded_, "loaded");
  archive.require((phases_.now() < Phase::probe || unloaded_) && (!done() || loaded_));
}

RunResult SpaceLoadRun::result() const {
  RunResult out;
  if (!unloaded_ || !loaded_) return out;
  out.snapshots = {{"unloaded", *unloaded_}, {"loaded", *loaded_}};
  auto& f = out.figures;
  add_engine_figures(*engine_,
                     by_newton() ? diagnostics_of(*loaded_, settings_) : engine_->measure(), f);
  add_reached("load", reached_, f);
  const auto sides = layer_sides(setup_.packing);
  add_layer_figures(*unloaded_, *loaded_, surface_3d(*unloaded_, setup_.packing), sides[0],
                    sides[0] * sides[1], f);
  f["load.force"] = force_of_load(setup_);
  f["load.force_over_weight"] =
      f["load.force"] /
      (setup_.material.density * mean_sphere_volume(setup_.packing) * setup_.material.gravity);
  f["load.grains"] = static_cast<double>(1 + loaded_->also_loaded.size());
  add_contact_changes(*unloaded_, *loaded_, f);
  return out;
}

}  // namespace

EngineSettings space_load_settings(const PointLoadSetup& s, int threads,
                                   const std::vector<ShapedGrain>& grains, double reserve) {
  check_packing(s.packing);
  const bool angular = is_angular(s.packing);
  if (angular && s.load.method == "newton") {
    throw std::invalid_argument(
        "load.method: found \"newton\" with packing.shape = \"superellipsoid\", allowed: "
        "\"damped\" "
        "(the quasi-static solver knows spheres)");
  }
  if (s.load.probe_strain > 0) {
    const char* found = angular                         ? "packing.shape = \"superellipsoid\""
                        : s.packing.sides != "periodic" ? "packing.sides = \"walls\""
                                                        : nullptr;
    if (found != nullptr) {
      throw std::invalid_argument(fmt::format(
          "load.probe_strain: found {:g} with {}, allowed: 0 (the quasi-static solver strains "
          "spheres in cells that repeat)",
          s.load.probe_strain, found));
    }
    check_method("load.probe_strain", "newton", s.material, s.motion, 3);
  }
  if (angular) check_superellipsoid_material(s.material);
  check_method("load.method", s.load.method, s.material, s.motion, 3);
  const bool falls = s.packing.kind == "random";
  const double depth = falls ? s.packing.depth : 2 * s.packing.rows * s.packing.radius;
  const double fall = falls ? std::max(0.0, loose_height(s.packing) - depth) : 0;
  check_stiff_enough(
      s.material, {mean_sphere_radius(s.packing), depth, std::sqrt(2 * s.material.gravity * fall)});
  const double least = smallest_radius(s.packing);
  GrainExtremes extremes;
  extremes.least_radius = least;
  extremes.least_mass = s.material.density * 4 / 3 * std::numbers::pi * least * least * least;
  if (angular) extremes = extremes_of_superellipsoids(grains, s.material.density);
  EngineSettings out = engine_settings(s.material, s.motion, extremes, threads, false, reserve,
                                       angular ? ShapeKind::superellipsoid : ShapeKind::sphere);
  out.gravity_y = 0;
  out.gravity_z = -s.material.gravity;
  out.cell = layer_cell(s.packing);
  check_background_damping(s.rest, out.time_step);
  if (s.load.method != "newton") {
    check_countable("load.ramp_time", s.load.ramp_time, out.time_step);
  }
  return out;
}

double force_of_load(const PointLoadSetup& s) {
  if (s.packing.dim == 2 || s.load.weights == 0) return s.load.force;
  return s.load.weights * s.material.density * mean_sphere_volume(s.packing) * s.material.gravity;
}

std::unique_ptr<Run> make_space_load_run(const PointLoadSetup& setup, std::uint64_t seed,
                                         int threads) {
  return std::make_unique<SpaceLoadRun>(setup, seed, threads);
}

}  // namespace grainfield::dem
