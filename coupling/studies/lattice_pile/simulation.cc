// A pile of equal disks on the triangular lattice comes to rest under its weight (Liffman et al.
// 1992): rest -> snapshot "pile".
#include "coupling/studies/lattice_pile/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>

#include "dem/grains/grain_family.h"
#include "dem/grains/lattice_pile.h"
#include "dem/run/fingerprint.h"
#include "dem/run/phases.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::dem {
namespace {

// Rest is judged every so many steps: cheap beside the steps themselves.
constexpr long kCheckEvery = 200;

enum class Phase : int { rest, done };

class LatticePileRun final : public ArchivedRun {
 public:
  LatticePileRun(const LatticePileSetup& setup, std::uint64_t seed, int threads)
      : setup_(setup), seed_(seed) {
    check_lattice(setup_.lattice);
    const double r = setup_.lattice.radius;
    const double mass = setup_.material.density * std::numbers::pi * r * r;
    settings_ = engine_settings(setup_.material, setup_.motion, {mass, 0}, threads);
    check_background_damping(setup_.rest, settings_.time_step);
    engine_ = empty_engine();
    for (const NewGrain& g : lattice_pile_grains(setup_.lattice, setup_.material.density)) {
      engine_->add(g);
    }
    engine_->set_background_damping(phases_.info().damped ? setup_.rest.background_damping : 0);
  }

  void advance(long steps) override {
    while (steps > 0 && !done()) {
      steps -= phases_.step(*engine_, steps, kCheckEvery);
      if (phases_.is_due(kCheckEvery)) decide();
    }
  }

  bool done() const override { return phases_.done(); }
  Progress progress() const override;
  RunResult result() const override;

 private:
  void decide();
  void visit(Archive& archive) override {
    phases_.visit(archive);
    archive.engine(engine_, [this] { return empty_engine(); });
    archive.snapshot(pile_, "pile");
    archive.require(done() == pile_.has_value());
  }
  std::string fingerprint() const override;
  std::unique_ptr<Engine> empty_engine() const {
    std::unique_ptr<Engine> engine = make_engine(settings_);
    engine->add_wall({"floor", Vec3(0, 0, 0), Vec3(0, 1, 0), setup_.material.floor_friction});
    return engine;
  }

  LatticePileSetup setup_;
  std::uint64_t seed_;
  EngineSettings settings_;
  Phases<Phase> phases_{{{"rest", true, 0, 1}, {"done", true, 1, 1}}};
  std::unique_ptr<Engine> engine_;
  std::optional<Snapshot> pile_;
};

void LatticePileRun::decide() {
  const Diagnostics d = engine_->measure();
  if (at_rest(d, setup_.rest)) {
    pile_ = engine_->snapshot();
    pile_->attributes["state"] = "pile";
    pile_->attributes["seed"] = fmt::format("{}", seed_);
    pile_->attributes["packing"] = "lattice";
    phases_.enter(Phase::done);
  } else if (engine_->time() > setup_.rest.max_time) {
    fail_to_rest(d, setup_.rest, "lattice pile", ", or lattice.slope_deg if the pile collapsed");
  }
}

Progress LatticePileRun::progress() const {
  const Diagnostics d = engine_->measure();
  Progress p = progress_of(*engine_, d);
  p.phase = phases_.info().name;
  p.fraction = phases_.fraction(rest_progress(d, setup_.rest));
  return p;
}

std::string LatticePileRun::fingerprint() const {
  return fmt::format("lattice pile {} {} {}", fingerprint_of(setup_), settings_.time_step, seed_);
}

RunResult LatticePileRun::result() const {
  RunResult out;
  if (!pile_) return out;
  out.snapshots = {{"pile", *pile_}};
  auto& f = out.figures;
  add_engine_figures(*engine_, engine_->measure(), f);
  double weight = 0;
  for (const Grain& g : pile_->grains) weight += g.mass * setup_.material.gravity;
  f["base.weight_ratio"] = base_force(*pile_).y() / weight;
  return out;
}

}  // namespace

std::unique_ptr<Run> make_lattice_pile_run(const LatticePileSetup& setup, std::uint64_t seed,
                                           int threads) {
  return std::make_unique<LatticePileRun>(setup, seed, threads);
}

Outlook foresee_lattice_pile(const LatticePileSetup& s) {
  check_lattice(s.lattice);
  Outlook out;
  for (const int row : lattice_rows(s.lattice)) out.grains += row;
  out.bytes = out.grains * kBytesOfDisk;
  out.bytes_key = "lattice.base_grains";
  GrainExtremes extremes;
  extremes.least_mass = s.material.density * disk_grain(s.lattice.radius).area;
  out.take_step(engine_settings(s.material, s.motion, extremes, 1));
  check_background_damping(s.rest, out.time_step);
  return out;
}

}  // namespace grainfield::dem
