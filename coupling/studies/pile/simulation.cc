// A sand pile (Roul ch. 3): pour -> settle -> rest with every grain awake -> snapshot "pile" ->
// changes of gravity -> "gravity_G".
#include "coupling/studies/pile/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/studies/pile/pile_checks.h"
#include "coupling/studies/pile/poured_run.h"
#include "dem/pouring/funnel.h"

namespace grainfield::dem {
namespace {

// Settled: mean kinetic energy of the grains that moved last below this share of m g r.
constexpr double kSettledShare = 0.01;

// In the order of PilePhase.
std::vector<PhaseInfo> phases_of(const PileSetup& setup) {
  const double rested = setup.change.gravity.empty() ? 1 : kEndOfRest;
  return {{"pour", false, 0, 0.7},
          {"settle", false, 0.7, 0.7},
          {"rest", true, 0.7, rested},
          {"change", true, rested, 1},
          {"done", true, 1, 1}};
}

}  // namespace

PileRun::PileRun(const PileSetup& setup, std::uint64_t seed, int threads)
    : PhasedRun(setup, seed, phases_of(setup)),
      random_(seed),
      drawn_(draw_all<PileGroundwork>(setup_, random_)),
      largest_diameter_(2 * largest_radius(drawn_.poured)),
      mean_diameter_(2 * mean_radius(drawn_.poured)) {
  take_settings(drawn_, threads);
  const SourceSetup& o = setup_.source;
  if (o.kind == "point") {
    const double fall = least_interval(o.speed, setup_.material.gravity, o.height);
    check_countable("source.interval", o.grains * o.interval + fall, settings_.time_step);
  }
  engine_ = empty_engine();
  add_floor_grains();
  add(funnel_plates(setup_.source, setup_.material.density));
  point_.emplace(setup_.source, setup_.material.gravity, settings_.time_step);
  line_ = {-0.5 * setup_.source.length, 0.5 * setup_.source.length};
  changes_.emplace(setup_.change, setup_.rest, settings_, smaller_step(setup_.motion));
}

std::unique_ptr<Engine> PileRun::empty_engine() const {
  std::unique_ptr<Engine> engine = make_engine(settings_);
  const double half = 0.5 * setup_.floor.length;
  // Below a rough floor's grains the plane is out of reach.
  const double depth = drawn_.floor.empty() ? 0 : 4 * largest_radius(drawn_.floor);
  const MaterialSetup& m = setup_.material;
  engine->add_wall({"floor", Vec3(0, -depth, 0), Vec3(0, 1, 0), m.floor_friction});
  engine->add_wall({"left", Vec3(-half, 0, 0), Vec3(1, 0, 0), m.wall_friction});
  engine->add_wall({"right", Vec3(half, 0, 0), Vec3(-1, 0, 0), m.wall_friction});
  return engine;
}

void PileRun::add_floor_grains() {
  // Side by side, their bounding circles' tops at y = 0, the rest of the length as equal gaps.
  const double half = 0.5 * setup_.floor.length;
  double slack = setup_.floor.length;
  for (const ShapedGrain& g : drawn_.floor) slack -= 2 * g.radius;
  const double gap = drawn_.floor.empty() ? 0 : slack / static_cast<double>(drawn_.floor.size());
  double x = -half;
  for (const ShapedGrain& shaped : drawn_.floor) {
    NewGrain g = shaped.at(x + 0.5 * gap + shaped.radius, -shaped.radius, setup_.material.density);
    g.fixed = true;
    engine_->add(g);
    x += 2 * shaped.radius + gap;
  }
}

void PileRun::advance(long steps) {
  while (!done()) {
    if (phases_.now() == PilePhase::change) {
      change(steps);
      return;
    }
    const long next = next_event();
    if (next > phases_.steps()) {
      if (steps <= 0) return;
      const long chunk = std::min(steps, next - phases_.steps());
      engine_->step(chunk);
      phases_.advance(chunk);
      steps -= chunk;
    }
    if (phases_.steps() >= next) decide();
  }
}

// The step, within the phase, at which something is decided. decide() moves it on.
long PileRun::next_event() const {
  const bool pours = phases_.now() == PilePhase::pour;
  if (!pours || setup_.source.kind == "line") {
    const long due = phases_.steps() + phases_.until_due(kCheckEvery);
    return pours && poured_ == 0 ? phases_.steps() : due;
  }
  long next = (awake_samples_ + 1) * kSampleEvery;
  if (poured_ < setup_.source.grains) next = std::min(next, point_->release_step(poured_));
  if (!in_flight_.empty()) next = std::min(next, in_flight_.front().step);
  return next;
}

void PileRun::decide() {
  switch (phases_.now()) {
    case PilePhase::pour:
      return setup_.source.kind == "line" ? pour_line() : pour_point();
    case PilePhase::settle:
      return settle();
    case PilePhase::rest:
      return rest();
    case PilePhase::change:
    case PilePhase::done:
      return;
  }
}

bool PileRun::settled(int grains) const {
  const double r = 0.5 * mean_diameter_;
  const double energy = setup_.material.density * total_area(drawn_.poured) / setup_.source.grains *
                        setup_.material.gravity * r;
  return engine_->motion().kinetic_energy <= kSettledShare * energy * grains;
}

void PileRun::record(int grains) {
  while (recorded_.size() < setup_.record.size() && grains >= setup_.record[recorded_.size()]) {
    recorded_.emplace_back(named_snapshot(*engine_, record_name(recorded_.size()), seed_, {}));
  }
}

std::string PileRun::record_name(std::size_t k) const {
  return fmt::format("poured_{:g}", setup_.record[k]);
}

void PileRun::rest() {
  const Diagnostics d = engine_->measure();
  if (!has_come_to_rest(d, "after the pour", smaller_step(setup_.motion))) return;
  at_pile_ = d;
  pile_ = named_snapshot(
      *engine_, "pile", seed_,
      {{"source", setup_.source.kind}, {"shape", setup_.shape.kind}, {"floor", setup_.floor.kind}});
  check_not_leaning(setup_, *pile_);
  changes_->start_from(*pile_);
  enter(changes_->done() ? PilePhase::done : PilePhase::change);
}

void PileRun::change(long steps) {
  std::function<bool(double)> watch;
  if (watch_) {
    watch = [this](double share) {
      Progress now = progress();
      now.fraction = kEndOfRest + (1 - kEndOfRest) * share;
      return watch_(now);
    };
  }
  changes_->advance(steps, watch);
  if (changes_->done()) enter(PilePhase::done);
}

bool is_change(const std::string& name) { return name.starts_with("gravity_"); }

std::unique_ptr<Run> make_pile_run(const PileSetup& setup, std::uint64_t seed, int threads) {
  return std::make_unique<PileRun>(setup, seed, threads);
}

}  // namespace grainfield::dem
