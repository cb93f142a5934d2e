// Progress, checkpoints and results of the run of a pile.
#include <fmt/format.h>

#include "coupling/studies/pile/pile_figures.h"
#include "coupling/studies/pile/poured_run.h"

namespace grainfield::dem {

const Engine& PileRun::at_work() const {
  return changes_->engine() != nullptr ? *changes_->engine() : *engine_;
}

std::string PileRun::phase_name() const {
  if (phases_.now() == PilePhase::pour) {
    return fmt::format("pour {}/{}", poured_, setup_.source.grains);
  }
  return phases_.now() == PilePhase::change ? changes_->phase() : PhasedRun::phase_name();
}

double PileRun::share(const Diagnostics& state) const {
  switch (phases_.now()) {
    case PilePhase::pour:
      return static_cast<double>(poured_) / setup_.source.grains;
    case PilePhase::rest:
      return rest_progress(state, setup_.rest);
    case PilePhase::change:
      return changes_->fraction();
    case PilePhase::settle:
    case PilePhase::done:
      break;
  }
  return 1;
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
  visit_engine(archive);
  auto recorded = static_cast<std::int64_t>(recorded_.size());
  archive(recorded);
  archive.require(recorded >= 0 && recorded <= static_cast<std::int64_t>(setup_.record.size()));
  recorded_.resize(static_cast<std::size_t>(recorded));
  for (std::size_t k = 0; k < recorded_.size(); ++k) {
    archive.snapshot(recorded_[k], record_name(k));
    archive.require(recorded_[k].has_value());
  }
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
  for (std::size_t k = 0; k < recorded_.size(); ++k) {
    out.snapshots.emplace_back(record_name(k), *recorded_[k]);
  }
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
