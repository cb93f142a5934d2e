// Progress, checkpoints and results of the run of a pile.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dem/study/pile_figures.h"
#include "dem/study/pile_run.h"

namespace grainfield::dem {

Snapshot PileRun::named(Snapshot s, const std::string& state) const {
  s.attributes["state"] = state;
  s.attributes["seed"] = fmt::format("{}", seed_);
  s.attributes["source"] = setup_.source.kind;
  s.attributes["shape"] = setup_.shape.kind;
  s.attributes["floor"] = setup_.floor.kind;
  return s;
}

Progress PileRun::progress() const {
  const Engine& at_work = changes_->engine() != nullptr ? *changes_->engine() : *engine_;
  const Diagnostics d = at_work.measure();
  Progress p;
  p.simulated_time = at_work.time();
  p.steps = at_work.steps();
  p.grains = engine_->grains();
  p.awake = d.awake;
  p.kinetic_energy = d.kinetic_energy;
  p.unbalanced_force_ratio = d.unbalanced_force_ratio;
  const double end_of_rest = setup_.change.gravity.empty() ? 1 : kEndOfRest;
  switch (phase_) {
    case PilePhase::pour:
      p.phase = fmt::format("pour {}/{}", poured_, setup_.source.grains);
      p.fraction = 0.7 * poured_ / setup_.source.grains;
      break;
    case PilePhase::settle:
      p.phase = "settle";
      p.fraction = 0.7;
      break;
    case PilePhase::rest:
      p.phase = "rest";
      p.fraction = 0.7 + (end_of_rest - 0.7) * rest_progress(d, setup_.rest);
      break;
    case PilePhase::change:
      p.phase = changes_->phase();
      p.fraction = kEndOfRest + (1 - kEndOfRest) * changes_->fraction();
      break;
    case PilePhase::done:
      p.phase = "done";
      p.fraction = 1;
      break;
  }
  return p;
}

std::string PileRun::fingerprint() const {
  const ShapeSetup& h = setup_.shape;
  const SourceSetup& o = setup_.source;
  const SleepSetup& s = setup_.sleep;
  return fmt::format(
      "pile {} {} {} {} {} {} {} [{}] | {} {} {} {} {} {} {} {} {} {} {} | {} {} | {} {} {} {} {} "
      "{} "
      "{} | {} | {} | {} | {} | {}",
      h.kind, h.radius, h.polydispersity, h.corners_min, h.corners_max, h.axis_ratio, h.side,
      fmt::join(h.outline, " "), o.kind, o.grains, o.speed, o.height, o.interval, o.spread,
      o.opening, o.move, o.clearance, o.length, o.shift, setup_.floor.kind, setup_.floor.length,
      s.on, s.quiet_time, s.quiet_move, s.quiet_force, s.wake_force, s.wake_speed, s.wake_reach,
      changes_->describe(), describe(setup_.material), describe(setup_.motion, settings_.time_step),
      describe(setup_.rest), seed_);
}

void PileRun::save(const std::string& file) const {
  ImageWriter w;
  w.put(phase_);
  w.put(phase_steps_);
  w.put(poured_);
  w.put(top_);
  w.put(std::vector<Flight>(in_flight_.begin(), in_flight_.end()));
  w.put(line_);
  w.put(layer_start_);
  w.put(layer_grains_);
  w.put(awake_sum_);
  w.put(awake_samples_);
  w.put(pour_time_);
  w.put(at_pile_);
  w.put(random_.state());
  w.put(engine_->image());
  NamedSnapshots snapshots;
  if (pile_) snapshots.emplace_back("pile", *pile_);
  changes_->save(w, snapshots);
  write_checkpoint(file, fingerprint(), w, snapshots);
}

void PileRun::restore(const std::string& file) {
  const std::string bytes = read_checkpoint(file, fingerprint());
  ImageReader r(bytes);
  std::vector<Flight> flights;
  std::uint64_t random_state = 0;
  std::string image;
  r.get(phase_);
  r.get(phase_steps_);
  r.get(poured_);
  r.get(top_);
  r.get(flights);
  r.get(line_);
  r.get(layer_start_);
  r.get(layer_grains_);
  r.get(awake_sum_);
  r.get(awake_samples_);
  r.get(pour_time_);
  r.get(at_pile_);
  r.get(random_state);
  r.get(image);
  r.require(poured_ <= setup_.source.grains);
  in_flight_.assign(flights.begin(), flights.end());
  random_.set_state(random_state);
  engine_ = empty_engine();
  engine_->restore(image);
  pile_.reset();
  if (phase_ > PilePhase::rest) {
    pile_ = read_snapshot(file, "/pile");
    changes_->start_from(*pile_);
  }
  changes_->restore(r, file);
  r.finish();
}

RunResult PileRun::result() const {
  RunResult out;
  if (!done()) return out;
  out.snapshots.emplace_back("pile", *pile_);
  auto& f = out.figures;
  add_engine_figures(*engine_, at_pile_, f);
  f["pile.pour_time"] = pour_time_;
  f["pile.awake_mean"] =
      awake_samples_ > 0 ? awake_sum_ / static_cast<double>(awake_samples_) : engine_->grains();
  f["pile.grains_not_poured"] = setup_.source.grains - poured_;
  f["pile.mean_diameter"] = mean_diameter_;
  add_heap_figures(*pile_, mean_diameter_, f);
  changes_->add_to(out);
  return out;
}

}  // namespace grainfield::dem
