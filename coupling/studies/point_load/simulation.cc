// A layer is built, comes to rest, and one of its top grains is loaded (Roul ch. 5):
//   build -> rest -> snapshot "unloaded" -> (in space: probe) -> load -> hold -> "loaded".
#include "coupling/studies/point_load/simulation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "coupling/studies/point_load/layer.h"
#include "coupling/studies/point_load/layer_figures.h"
#include "coupling/studies/point_load/layer_probe.h"
#include "coupling/studies/point_load/load_by_newton.h"
#include "coupling/studies/point_load/piston.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/run/phased_run.h"
#include "dem/snapshot/added_forces_mark.h"
#include "dem/snapshot/images.h"

namespace grainfield::dem {
namespace {

// In the plane there is no probe.
template <int D>
struct LoadPhase {
  enum Phase : int { build, rest, probe = D == 3 ? 2 : -1, load = D, hold, done };
};

bool probes(const PointLoadSetup& s) { return s.packing.dim == 3 && s.load.probe_strain > 0; }

// In the order of LoadPhase.
template <int D>
std::vector<PhaseInfo> phases_of(const PointLoadSetup& s) {
  const double built = Layer<D>::falls(s) ? Layer<D>::kBuilding : 0;
  const double rested = 0.5 + (D == 2 ? 0.5 : 0.2) * built;
  const double probed = probes(s) ? rested + 0.4 * (1 - rested) : rested;
  const double loaded = probed + 0.4 * (1 - probed);
  std::vector<PhaseInfo> out{{"build", false, 0, built},      {"rest", true, built, rested},
                             {"probe", true, rested, probed}, {"load", true, probed, loaded},
                             {"hold", true, loaded, 1},       {"done", true, 1, 1}};
  if (D == 2) out.erase(out.begin() + 2);
  return out;
}

// Seen from above, by the nearest of periodic images, m.
double apart(const Snapshot& s, const Vec3& a, const Vec3& b) {
  Vec3 way = a - b;
  way[s.dim - 1] = 0;
  way += shift_to(s.cell, nearest_image(s.cell, way));
  return way.head<2>().norm();
}

struct SharedForce {
  AppliedForce force;                ///< on each
  std::vector<std::int64_t> beside;  ///< the others that carry it
};

template <int D>
class PointLoadRun final : public PhasedRun<Layer<D>, typename LoadPhase<D>::Phase> {
  using Base = PhasedRun<Layer<D>, typename LoadPhase<D>::Phase>;
  using Is = LoadPhase<D>;
  using Base::engine_, Base::phases_, Base::setup_, Base::settings_;

 public:
  PointLoadRun(const PointLoadSetup& setup, std::uint64_t seed, int threads)
      : Base(setup, seed, phases_of<D>(setup)), layer_(setup, seed) {
    Base::take_settings(layer_.grains(), threads);
    if (!by_newton() && !by_piston()) {
      check_countable("load.ramp_time", setup_.load.ramp_time, settings_.time_step);
    }
    engine_ = empty_engine();
    layer_.begin(*engine_);
    Base::enter(Layer<D>::falls(setup_) ? Is::build : Is::rest);
  }

  Progress progress() const override {
    Progress p = Base::progress();
    p.steps += steps_before_;
    p.simulated_time += time_before();
    return p;
  }

  RunResult result() const override {
    RunResult out;
    if (!unloaded_ || !loaded_) return out;
    out.snapshots = {{"unloaded", *unloaded_}, {"loaded", *loaded_}};
    auto& f = out.figures;
    add_engine_figures(*engine_,
                       by_newton() ? diagnostics_of(*loaded_, settings_) : engine_->measure(), f);
    f["dem.steps"] += static_cast<double>(steps_before_);
    const std::vector<double> sides = Layer<D>::sides(setup_);
    add_layer_figures(*unloaded_, *loaded_, Layer<D>::height(*unloaded_, setup_), sides.front(),
                      D == 2 ? sides[0] : sides[0] * sides[1], f);
    f["load.force"] = force_of_load(setup_);
    Layer<D>::add_figures(setup_, *loaded_, f);
    if (by_piston()) f["load.time"] = stroke_.end - stroke_.start;
    add_reached("load", reached_, f);
    if (setup_.load.rest == "newton") f["rest.by_newton"] = finish_ == Finish::done ? 1 : 0;
    add_reached("rest", rested_, f);
    add_contact_changes(*unloaded_, *loaded_, f);
    return out;
  }

 private:
  bool by_newton() const { return setup_.load.method == "newton"; }
  bool by_piston() const { return setup_.load.control == "speed"; }

  std::unique_ptr<Engine> empty_engine() const override {
    std::unique_ptr<Engine> engine = make_engine(settings_);
    for (const Wall& wall : Layer<D>::walls(setup_)) engine->add_wall(wall);
    if (piston_) added_forces(*engine).add_force(piston_);
    return engine;
  }

  bool acts_at_once() override {
    if (phases_.now() == Is::rest && finish_ == Finish::due) return finish_rest(), true;
    if (phases_.now() == Is::probe) return probe(), true;
    if (phases_.now() == Is::load && by_newton()) return solve(), true;
    return false;
  }

  void decide() override {
    switch (phases_.now()) {
      case Is::build:
        switch (layer_.go_on(*engine_, Base::in_phase())) {
          case Built::yes:
            return Base::enter(Is::rest);
          case Built::in_part:
            return phases_.restart();
          case Built::no:
            if (D == 3 && Base::in_phase() > setup_.rest.max_time) {
              fail_to_rest(engine_->measure(), setup_.rest, "while the spheres settle", "");
            }
        }
        return;
      case Is::rest:
        if (has_come_to_rest("before the load")) return leave_rest(take_snapshot("unloaded"));
        if (finish_ == Finish::later && energy_at_rest(engine_->measure(), setup_.rest)) {
          finish_ = Finish::due;
        }
        return;
      case Is::hold:
        if (!has_come_to_rest("after the load")) return;
        loaded_ = take_snapshot("loaded");
        return phases_.enter(Is::done);
      case Is::load:
        if (by_piston() ? presses() : Base::in_phase() >= setup_.load.ramp_time) {
          Base::enter(Is::hold);
        }
        return;
      case Is::probe:
      case Is::done:
        return;
    }
  }
  bool has_come_to_rest(const char* when) const {
    return Base::has_come_to_rest(engine_->measure(), when, Layer<D>::kLowerLoad);
  }

  void leave_rest(Snapshot state) {
    unloaded_ = std::move(state);
    probes(setup_) ? Base::enter(Is::probe) : begin_load();
  }

  // Newton's method brings the layer from near rest to rest; where it fails, damped dynamics go on.
  // Told to stop it leaves the run as it was.
  void finish_rest() {
    std::optional<LayerByNewton> done;
    try {
      done = rest_by_newton(take_snapshot("unloaded"), settings_, setup_.rest,
                            this->watch_of("rest by Newton's method"));
    } catch (const RelaxationStopped&) {
      return;
    }
    finish_ = done ? Finish::done : Finish::failed;
    if (!done) return;
    rested_ = done->reached;
    steps_before_ = engine_->steps();
    engine_ = make_engine(settings_, done->state);
    leave_rest(std::move(done->state));
  }

  // The rest before the probes, one more probe, or the load. Told to stop it leaves the run as it
  // was.
  void probe() {
    if (probed_ == LayerProber::count()) {
      prober_.reset();
      return begin_load();
    }
    if (!prober_) {
      LayerProber prober(*unloaded_, settings_, Layer<D>::height(*unloaded_, setup_),
                         setup_.load.probe_strain);
      if (prober.settle(this->watch_of("probe"))) prober_.emplace(std::move(prober));
      return;
    }
    const auto outcome = prober_->probe(probed_, this->watch_of("probe"));
    if (!outcome) return;
    StateProbes all = probes_of(*unloaded_, kProbedLayer);
    all.stress = prober_->stress_before();
    add_outcome(all, LayerProber::direction(probed_), probed_, *outcome);
    put_probes(all, *unloaded_);
    ++probed_;
  }

  void begin_load() {
    Base::enter(Is::load);
    if (by_newton()) return;
    SharedForce load = load_on(*unloaded_);
    if (by_piston()) {
      const Grain& grain = unloaded_->grains[static_cast<std::size_t>(load.force.id)];
      stroke_ = {load.force.id, engine_->time(), grain.position[D - 1], 0};
      piston_ = piston();
      added_forces(*engine_).add_force(piston_);
      return;
    }
    load.force.start = engine_->time();
    load.force.ramp = setup_.load.ramp_time;
    engine_->apply(load.force, load.beside);
  }

  std::shared_ptr<Piston> piston() const {
    return std::make_shared<Piston>(stroke_, setup_.load.speed, Piston::stiffness(setup_.material),
                                    force_of_load(setup_));
  }
  // Whether the grain resists with the whole force: then this force takes the piston's place.
  bool presses() {
    if (!piston_->presses_fully()) {
      if (Base::in_phase() > setup_.rest.max_time) piston_->fail(setup_.rest.max_time);
      return false;
    }
    stroke_.end = engine_->time();
    added_forces(*engine_).remove_force(piston_->name());
    piston_.reset();
    const SharedForce load = load_on(*unloaded_);
    engine_->apply(load.force, load.beside);
    return true;
  }

  // The load by Newton's method. Told to stop it leaves the run as it was.
  void solve() {
    const SharedForce load = load_on(*unloaded_);
    std::optional<LayerByNewton> done = load_by_newton(
        *unloaded_, settings_, setup_.load, load.force, load.beside, this->watch_of("load"));
    if (!done) return;
    reached_ = done->reached;
    loaded_ = std::move(done->state);
    phases_.enter(Is::done);
  }

  SharedForce load_on(const Snapshot& s) const {
    SharedForce out;
    out.force.id = choose_loaded_grain(s);
    out.beside = others_loaded(s, out.force.id);
    (D == 2 ? out.force.fy : out.force.fz) =
        -force_of_load(setup_) / static_cast<double>(1 + out.beside.size());
    return out;
  }

  // The grains within load.radius of that one whose centres no higher grain covers.
  std::vector<std::int64_t> others_loaded(const Snapshot& s, std::int64_t first) const {
    std::vector<std::int64_t> out;
    if (D == 2) return out;
    const Vec3& middle = s.grains[static_cast<std::size_t>(first)].position;
    for (const Grain& g : s.grains) {
      if (g.fixed || g.id == first || apart(s, g.position, middle) > setup_.load.radius) continue;
      const bool covered = std::any_of(s.grains.begin(), s.grains.end(), [&](const Grain& other) {
        return other.position.z() > g.position.z() &&
               apart(s, other.position, g.position) < other.radius;
      });
      if (!covered) out.push_back(g.id);
    }
    return out;
  }

  // The highest grain near the wanted place, or where there is none farther away; ties go to the
  // nearer one.
  std::int64_t choose_loaded_grain(const Snapshot& s) const {
    const std::vector<double> sides = Layer<D>::sides(setup_);
    Vec3 wanted((setup_.load.position - 0.5) * sides[0], 0, 0);
    if (D == 3) wanted.y() = (setup_.load.position_y - 0.5) * sides[1];
    std::int64_t best = -1;
    double height = 0;
    for (double reach = Layer<D>::kReach * largest_radius(setup_.packing); best < 0; reach *= 2) {
      for (const Grain& g : s.grains) {
        const double aside = apart(s, g.position, wanted);
        if (g.fixed || aside > reach) continue;
        const double key = g.position[D - 1] - 1e-3 * aside;
        if (best < 0 || key > height) {
          best = g.id;
          height = key;
        }
      }
    }
    return best;
  }

  Snapshot take_snapshot(const char* state) const {
    Snapshot s =
        named_snapshot(*engine_, state, this->seed_,
                       {{"packing", setup_.packing.kind}, {"floor", setup_.packing.floor}});
    s.time += time_before();
    s.attributes.erase(kFormerAddedForces);  // the piston is no force of the caller's own
    return s;
  }
  double time_before() const { return static_cast<double>(steps_before_) * settings_.time_step; }

  std::string phase_name() const override {
    if (phases_.now() == Is::build) return layer_.phase();
    const bool alone = phases_.now() == Is::rest && finish_ == Finish::failed;
    return Base::phase_name() + (alone ? " (Newton's method failed)" : "");
  }
  double share(const Diagnostics& d) const override {
    switch (phases_.now()) {
      case Is::build:
        return layer_.share(d, Base::in_phase());
      case Is::rest:
      case Is::hold:
        return rest_progress(d, setup_.rest);
      case Is::load:
        if (piston_) return piston_->force() / force_of_load(setup_);
        return Base::in_phase() / std::max(setup_.load.ramp_time, 1e-300);
      case Is::probe:
        return static_cast<double>(probed_) / LayerProber::count();
      case Is::done:
        break;
    }
    return 1;
  }

  void visit(Archive& archive) override {
    phases_.visit(archive);
    layer_.visit(archive);
    if (D == 3) {
      archive(probed_);
      archive.require(probed_ >= 0 && probed_ <= LayerProber::count());
    }
    archive(reached_);
    archive(finish_);
    archive.require(finish_ <= Finish::failed);
    archive(rested_);
    archive(steps_before_);
    archive.require(steps_before_ >= 0);
    if (by_piston()) {
      archive(stroke_);
      if (archive.is_reading()) piston_ = phases_.now() == Is::load ? piston() : nullptr;
    }
    Base::visit_engine(archive);
    archive.snapshot(unloaded_, "unloaded");
    archive.snapshot(loaded_, "loaded");
    archive.require((phases_.now() <= Is::rest || unloaded_) && (!this->done() || loaded_));
  }

  Layer<D> layer_;
  std::optional<Snapshot> unloaded_, loaded_;
  std::optional<LayerProber> prober_;  // settled; made anew after a resume
  int probed_ = 0;                     // probes that are done
  Reached reached_;                    // by Newton's method
  Stroke stroke_;
  std::shared_ptr<Piston> piston_;  // while it comes down
  // The rest by Newton's method: `never` without it, `due` when the energy is at rest.
  enum class Finish : int { never, later, due, done, failed };
  Finish finish_ = setup_.load.rest == "newton" ? Finish::later : Finish::never;
  Reached rested_;         // by Newton's method
  long steps_before_ = 0;  // of the engine that Newton's method took over from
};

}  // namespace

std::unique_ptr<Run> make_point_load_run(const PointLoadSetup& setup, std::uint64_t seed,
                                         int threads) {
  if (setup.packing.dim == 3) return std::make_unique<PointLoadRun<3>>(setup, seed, threads);
  return std::make_unique<PointLoadRun<2>>(setup, seed, threads);
}

Outlook foresee_point_load(const PointLoadSetup& setup, const std::vector<std::uint64_t>& seeds,
                           std::int64_t draws) {
  return setup.packing.dim == 3 ? foresee<Layer<3>>(setup, seeds, draws)
                                : foresee<Layer<2>>(setup, seeds, draws);
}

}  // namespace grainfield::dem
