// A pile of equal disks on the triangular lattice comes to rest under its weight (Liffman et al.
// 1992): rest -> snapshot "pile".
#include "dem/packing/lattice_pile.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>

#include "dem/snapshot/contact_changes.h"
#include "dem/study/common.h"
#include "dem/study/run.h"

namespace grainfield::dem {
namespace {

// Rest is judged every so many steps: cheap beside the steps themselves.
constexpr long kCheckEvery = 200;

class LatticePileRun final : public Run {
 public:
  LatticePileRun(const LatticePileSetup& setup, std::uint64_t seed, int threads)
      : setup_(setup), seed_(seed) {
    check_lattice(setup_.lattice);
    const double r = setup_.lattice.radius;
    const double mass = setup_.material.density * std::numbers::pi * r * r;
    const EngineSettings settings =
        engine_settings(setup_.material, setup_.motion, {mass, 0}, threads);
    check_background_damping(setup_.rest, settings.time_step);
    engine_ = make_engine(settings);
    engine_->add_wall({"floor", Vec3(0, 0, 0), Vec3(0, 1, 0), setup_.material.floor_friction});
    for (const NewGrain& g : lattice_pile_grains(setup_.lattice, setup_.material.density)) {
      engine_->add(g);
    }
    engine_->set_background_damping(setup_.rest.background_damping);
  }

  void advance(long steps) override {
    while (steps > 0 && !done()) {
      const long chunk = std::min(steps, kCheckEvery - engine_->steps() % kCheckEvery);
      engine_->step(chunk);
      steps -= chunk;
      if (engine_->steps() % kCheckEvery == 0) decide();
    }
  }

  bool done() const override { return pile_.has_value(); }
  Progress progress() const override;
  void save(const std::string& file) const override;
  void restore(const std::string& file) override;
  RunResult result() const override;

 private:
  void decide();
  std::string fingerprint() const;

  LatticePileSetup setup_;
  std::uint64_t seed_;
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
  } else if (engine_->time() > setup_.rest.max_time) {
    fail_to_rest(d, setup_.rest, "lattice pile", ", or lattice.slope_deg if the pile collapsed");
  }
}

Progress LatticePileRun::progress() const {
  const Diagnostics d = engine_->measure();
  Progress p;
  p.phase = done() ? "done" : "rest";
  p.fraction = done() ? 1 : rest_progress(d, setup_.rest);
  p.simulated_time = engine_->time();
  p.steps = engine_->steps();
  p.grains = p.awake = engine_->grains();
  p.kinetic_energy = d.kinetic_energy;
  p.unbalanced_force_ratio = d.unbalanced_force_ratio;
  return p;
}

std::string LatticePileRun::fingerprint() const {
  const LatticeSetup& l = setup_.lattice;
  return fmt::format("lattice pile {} {} {} {} | {} | {} | {} | {}", l.base_grains, l.slope_deg,
                     l.radius, l.gap, describe(setup_.material),
                     describe(setup_.motion, engine_->time_step()), describe(setup_.rest), seed_);
}

void LatticePileRun::save(const std::string& file) const {
  ImageWriter w;
  w.put(done());
  w.put(engine_->image());
  NamedSnapshots snapshots;
  if (pile_) snapshots.emplace_back("pile", *pile_);
  write_checkpoint(file, fingerprint(), w, snapshots);
}

void LatticePileRun::restore(const std::string& file) {
  const std::string bits = read_checkpoint(file, fingerprint());
  ImageReader r(bits);
  bool finished = false;
  std::string image;
  r.get(finished);
  r.get(image);
  r.finish();
  engine_->restore(image);
  pile_.reset();
  if (finished) pile_ = read_snapshot(file, "/pile");
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

}  // namespace grainfield::dem
