// Progress, checkpoints and results of the run of a pile.
#include <fmt/format.h>

#include "coupling/studies/pile/pile_figures.h"
#include "coupling/studies/pile/poured_run.h"
#include "dem/run/fingerprint.h"

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
  Progress p = progress_of(at_work, d);
  p.grains = engine_->grains();
  p.phase = phases_.info().name;
  switch (phases_.now()) {
    case PilePhase::pour:
      p.phase = fmt::format("pour {}/{}", poured_, setup_.source.grains);
      p.fraction = phases_.fraction(static_cast<double>(poured_) / setup_.source.grains);
      break;
    case PilePhase::rest:
      p.fraction = phases_.fraction(rest_progress(d, setup_.rest));
      break;
    case PilePhase::change:
      p.phase = changes_->phase();
      p.fraction = phases_.fraction(changes_->fraction());
      break;
    case PilePhase::settle:
    case PilePhase::done:
      p.fraction = phases_.fraction(1);
      break;
  }
  return p;
}

std::string PileRun::fingerprint() const {
  return fmt::format("pile {} {} {}", fingerprint_of(setup_), settings_.time_step, seed_);
}

void PileRun::visit(Archive& archive) {
  phases_.visit(archive);
  archive(poured_);
  archive.require(poured_ <= setup_.source.grains);
  archive(top_);
  std::vector<Flight> flights(in_flight_.begin(), in_flight_.end());
  archive(flights);
  in_flight_.assign(flights.begin(), flights.end());
  archive(line_);
  archive(layer_start_);
  archive(layer_grains_);
  archive(awake_sum_);
  archive(awake_samples_);
  archive(pour_time_);
  archive(at_pile_);
  archive(random_);
  archive.engine(engine_, [this] { return empty_engine(); });
  archive.snapshot(poured_pile_, "poured");
  archive.require(poured_pile_.has_value() == (phases_.now() > PilePhase::settle));
  archive.snapshot(pile_, "pile");
  archive.require(pile_.has_value() == (phases_.now() > PilePhase::rest));
  if (archive.is_reading() && pile_) changes_->start_from(*pile_);
  changes_->visit(archive);
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
  add_relaxation_figures(*poured_pile_, *pile_, mean_diameter_, f);
  changes_->add_to(out);
  return out;
}

}  // namespace grainfield::dem
