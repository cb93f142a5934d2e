// A pile of equal disks on the triangular lattice comes to rest under its weight (Liffman et al.
// 1992): rest -> snapshot "pile".
#include "coupling/studies/lattice_pile/simulation.h"

#include <numbers>
#include <optional>

#include "dem/grains/lattice_pile.h"
#include "dem/run/phased_run.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::dem {
namespace {

enum class Phase : int { rest, done };

struct LatticeGroundwork {
  using Setup = LatticePileSetup;
  static constexpr const char* kName = "lattice pile";
  static void check(const Setup& s) { check_lattice(s.lattice); }
  /// The radius.
  static double draw(const Setup& s, Random&, Allowance&) { return s.lattice.radius; }
  static EngineSettings settings(const Setup& s, double r, double reserve) {
    GrainExtremes extremes;
    extremes.least_mass = s.material.density * std::numbers::pi * r * r;
    EngineSettings out = engine_settings(s.material, s.motion, extremes, 1, false, reserve);
    check_background_damping(s.rest, out.time_step);
    return out;
  }
  static Outlook outlook(const Setup& s, const EngineSettings& settings) {
    Outlook out;
    out.take_step(settings);
    for (const int row : lattice_rows(s.lattice)) out.grains += row;
    out.bytes = out.grains * kBytesOfDisk;
    out.bytes_key = "lattice.base_grains";
    return out;
  }
};

class LatticePileRun final : public PhasedRun<LatticeGroundwork, Phase> {
 public:
  LatticePileRun(const LatticePileSetup& setup, std::uint64_t seed, int threads)
      : PhasedRun(setup, seed, {{"rest", true, 0, 1}, {"done", true, 1, 1}}) {
    take_settings(setup_.lattice.radius, threads);
    engine_ = empty_engine();
    add(lattice_pile_grains(setup_.lattice, setup_.material.density));
    enter(Phase::rest);
  }
  RunResult result() const override;

 private:
  void decide() override {
    const std::string remedy = ", or lattice.slope_deg if the pile collapsed";
    if (!has_come_to_rest(engine_->measure(), "lattice pile", remedy)) return;
    pile_ = named_snapshot(*engine_, "pile", seed_, {{"packing", "lattice"}});
    phases_.enter(Phase::done);
  }
  double share(const Diagnostics& state) const override {
    return rest_progress(state, setup_.rest);
  }
  void visit(Archive& archive) override {
    phases_.visit(archive);
    visit_engine(archive);
    archive.snapshot(pile_, "pile");
    archive.require(done() == pile_.has_value());
  }
  std::unique_ptr<Engine> empty_engine() const override {
    std::unique_ptr<Engine> engine = make_engine(settings_);
    engine->add_wall({"floor", Vec3(0, 0, 0), Vec3(0, 1, 0), setup_.material.floor_friction});
    return engine;
  }

  std::optional<Snapshot> pile_;
};

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

Outlook foresee_lattice_pile(const LatticePileSetup& setup) {
  return foresee<LatticeGroundwork>(setup, {0}, 1);
}

}  // namespace grainfield::dem
