// Grains placed loosely are compressed, rest, and are deformed:
//   (drop ->) (compress -> rest) (-> probe) (-> precompress (, settle)) (-> probe) -> snapshot
//   "state_000" -> deform (-> unload), with a snapshot at equal steps of strain, or of the axial
//   stress as it is unloaded.
// A periodic cell is led by its velocity gradient, between walls by their motion; where a stress is
// held, by CellServo here and by the engine's servos there.
#include "coupling/studies/sample/simulation/sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "coupling/studies/sample/simulation/cell.h"
#include "coupling/studies/sample/simulation/checks.h"
#include "coupling/studies/sample/simulation/drop.h"
#include "coupling/studies/sample/simulation/goal.h"
#include "coupling/studies/sample/simulation/probe.h"
#include "coupling/studies/sample/simulation/record.h"
#include "coupling/studies/sample/simulation/servo.h"
#include "coupling/studies/sample/simulation/state.h"
#include "coupling/studies/sample/simulation/view.h"
#include "coupling/studies/sample/simulation/walls.h"
#include "dem/run/phased_run.h"
#include "dem/walls/box.h"

namespace grainfield::dem {
namespace {

using Phase = SamplePhase;

// Steps between two decisions: of the compression and of a cell's servo; of an unloading to a
// stress; of sides that tilt.
constexpr long kServoEvery = 3, kUnloadEvery = 20, kTiltEvery = 100;
// Solid fractions near which pressures are reached, about; for the progress.
constexpr double kDense2 = 0.84, kDense3 = 0.64;
// Spheres of a gap are drawn from a seed of their own.
constexpr std::uint64_t kGapSeed = 0x9a95b1e5;

std::string snapshot_seed(const Snapshot& s) {
  const auto at = s.attributes.find("seed");
  return at == s.attributes.end() ? "unknown" : at->second;
}

std::vector<ShapedGrain> shapes_of(const Snapshot& s) {
  std::vector<ShapedGrain> out;
  for (const Grain& g : s.grains) {
    ShapedGrain& grain = out.emplace_back();
    grain.radius = g.radius;
    grain.area = g.volume;
    grain.axes = {g.axes[0], g.axes[1], g.axes[2]};
    grain.exponents = g.exponents;
  }
  return out;
}

class SampleRun final : public PhasedRun<SampleGroundwork, Phase> {
 public:
  SampleRun(const SampleSetup& setup, std::uint64_t seed, int threads, const Snapshot* filled);

  void advance(long steps) override;
  RunResult result() const override;

 private:
  int last() const { return plan_.dim - 1; }
  bool periodic() const { return is_periodic(plan_); }
  bool is_led_now() const { return any_led(plan_, phases_.now()); }
  long every() const;
  /// So many steps from now.
  double strain(long steps = 0) const {
    const double step = engine_->time_step();
    return strain_in(plan_, phases_.now(), in_phase() + static_cast<double>(steps) * step, step);
  }
  Vec3 pressure() const { return held_pressure(plan_, *engine_); }
  double fraction() const { return solid_fraction(plan_, *engine_, solid_volume_); }
  double compressed() const {
    return compressed_share(plan_, sample_edges(plan_, *engine_)[last()], box_[last()], fraction());
  }
  Cell<3> cell_at_start() const;
  std::unique_ptr<Engine> empty_engine() const override;
  double share(const Diagnostics& state) const override;
  double wall_friction() const;
  void take_settings(const std::vector<ShapedGrain>& grains, int threads);
  void go_on_from(FilledBox box);
  /// Between grains, in this phase.
  double friction() const {
    return has_other_friction(plan_) && prepares() ? plan_.prepared_friction : settings_.friction;
  }
  bool prepares() const { return phases_.now() <= Phase::rest; }
  void change_friction();

  void begin(Phase phase);
  void decide() override;
  void decide_drop();
  void decide_compression();
  void decide_rest();
  void probe(long steps);
  void decide_deformation();
  Phase after(Phase phase) const;
  void lead();
  void note_error();
  void record();
  void plan_next_record();
  double unloading_level() const;
  void visit(Archive& archive) override;
  std::string fingerprint() const override;

  const SamplePlan& plan_ = setup_.plan;
  std::string filled_from_;      // seed of the run that has filled the box, or nothing
  std::array<double, 3> box_{};  // edges at the start, m
  double solid_volume_ = 0;      // of all grains, m3 (m2)
  double dropped_fraction_ = 0;  // solid fraction as the lid has been put on
  int gap_spheres_ = 0;          // below it
  double compression_time_ = 0;  // s, at least
  CellServo cell_servo_;
  SampleProber prober_{setup_};
  // Steps of the phase until the next state; of an unloading to a stress the steps at which the
  // deformation would have been taken back twice.
  long next_record_ = 0;
  // The servos' errors in the deformation: the largest, the sum of squares, and how often measured.
  double stress_error_ = 0, squared_errors_ = 0;
  std::int64_t measured_ = 0;
  std::vector<std::optional<Snapshot>> states_;
};

SampleRun::SampleRun(const SampleSetup& setup, std::uint64_t seed, int threads,
                     const Snapshot* filled)
    : PhasedRun(setup, seed,
                {{"drop", true, 0, 0.2},
                 {"compress", true, 0, 0.3},
                 {"rest", true, 0.3, 0.4},
                 {"probe", true, 0.4, 0.42},
                 {"precompress", false, 0.42, 0.5},
                 {"settle", true, 0.5, 0.53},
                 {"probe", true, 0.53, 0.55},
                 {"deform", false, 0.55, 0.8},
                 {"unload", false, 0.8, 1},
                 {"done", false, 1, 1}}) {
  const double density = setup_.material.density;
  if (filled != nullptr) {
    FilledBox box = filled_box(*filled, plan_, density);
    filled_from_ = snapshot_seed(*filled);
    take_settings(shapes_of(box.snapshot), threads);
    go_on_from(std::move(box));
    return;
  }
  Random random(seed);
  const std::vector<ShapedGrain> grains = draw_sample(plan_, random);
  take_settings(grains, threads);
  solid_volume_ = total_area(grains);
  box_ = sample_box(plan_, solid_volume_);
  settings_.cell = cell_at_start();

  cell_servo_ = cell_servo_for(setup_, settings_);
  cell_servo_.interval = kServoEvery * settings_.time_step;

  engine_ = empty_engine();
  add(place_sample(plan_, grains, box_, density, random));
  begin(is_dropped(plan_) ? Phase::drop : Phase::compress);
}

void SampleRun::take_settings(const std::vector<ShapedGrain>& grains, int threads) {
  const SampleFrame frame = SampleGroundwork::settings(setup_, grains);
  settings_ = frame.settings;
  compression_time_ = frame.compression_time;
  settings_.threads = threads;
}

// With its lid on, at rest and without gravity.
void SampleRun::go_on_from(FilledBox box) {
  gap_spheres_ = box.spheres;
  dropped_fraction_ = box.solid_share;
  for (const Wall& wall : box.snapshot.walls) {
    if (wall.name == "right") box_[0] = wall.point.x();
    if (wall.name == "back") box_[1] = wall.point.y();
  }
  box_[2] = box.height;
  solid_volume_ = box.solid_share * box_[0] * box_[1] * box_[2];
  EngineSettings settings = settings_;
  settings.friction = friction();
  for (Wall& wall : box.snapshot.walls) wall.friction = wall_friction();
  engine_ = make_engine(settings, box.snapshot);
  check_fraction_ahead(plan_, fraction());
  begin(starts_as_filled(plan_) ? after(Phase::rest) : Phase::compress);
}

Cell<3> SampleRun::cell_at_start() const {
  Cell<3> cell;
  if (!periodic()) return cell;
  for (int a = 0; a < plan_.dim; ++a) {
    cell.periodic[a] = true;
    cell.edges(a, a) = box_[a];
  }
  return cell;
}

// In this phase.
double SampleRun::wall_friction() const {
  const double own = setup_.material.wall_friction;
  return has_other_friction(plan_) && prepares() ? std::min(own, plan_.prepared_friction) : own;
}

// With the friction of the phase.
std::unique_ptr<Engine> SampleRun::empty_engine() const {
  EngineSettings settings = settings_;
  settings.friction = friction();
  std::unique_ptr<Engine> engine = make_engine(settings);
  if (periodic()) return engine;
  Vec3 high(box_[0], box_[1], box_[2]);
  if (plan_.dim == 2) high.z() = 0;
  for (const Wall& wall : box_walls(Vec3::Zero(), high, wall_friction(), plan_.dim)) {
    engine->add_wall(wall);
  }
  return engine;
}

// The same grains, contacts and walls go on with the friction of the phase.
void SampleRun::change_friction() {
  const std::string checkpoint = engine_->checkpoint();
  engine_ = empty_engine();
  engine_->restore(checkpoint);
}

long SampleRun::every() const {
  const Phase now = phases_.now();
  if (now == Phase::compress || (periodic() && is_led_now())) return kServoEvery;
  if (now == Phase::unload && plan_.unload == "stress") return kUnloadEvery;
  return deforms(now) && tilts(plan_) ? kTiltEvery : kCheckEvery;
}

void SampleRun::advance(long steps) {
  while (steps > 0 && !done()) {
    long chunk = std::min(steps, phases_.until_due(every()));
    if (phases_.now() == Phase::rest || phases_.now() == Phase::settle) {
      chunk = std::min(chunk, phases_.until_due(kCheckEvery));
    }
    if (deforms(phases_.now()) || phases_.now() == Phase::precompress) {
      chunk = std::min(chunk, next_record_ - phases_.steps());
    }
    if (probes(phases_.now())) chunk = std::min(steps, prober_.until_due());
    engine_->step(chunk);
    phases_.advance(chunk);
    steps -= chunk;
    probes(phases_.now()) ? probe(chunk) : decide();
  }
}

void SampleRun::begin(Phase phase) {
  const bool prepared = prepares();
  if (phase == Phase::rest || phase == Phase::settle) {
    check_not_crushed(setup_, engine_->measure(), "after the compression",
                      phase == Phase::settle ? "precompression" : goal_key(plan_));
  }
  phases_.enter(phase);
  if (has_other_friction(plan_) && prepared && !prepares()) change_friction();
  if (probes(phase)) {
    const bool held = !periodic() && compresses_to_pressure(plan_) &&
                      !(phase == Phase::probe_first && precompresses(plan_));
    return prober_.begin(*engine_, phase == Phase::probe_first ? "first" : "prepared", held);
  }
  const bool drops = phase == Phase::drop;
  engine_->set_background_damping(drops                   ? plan_.drop_damping
                                  : phases_.info().damped ? setup_.rest.background_damping
                                                          : 0);
  if (drops) engine_->set_gravity(0, 0, -plan_.drop_gravity);
  cell_servo_.forget();
  if (phase == Phase::precompress) {
    next_record_ = steps_to(plan_, plan_.precompression, engine_->time_step());
  }
  if (phase == Phase::deform) record();
  if (phase == Phase::unload) plan_next_record();
  if (phase != Phase::done) lead();
}

void SampleRun::decide() {
  const bool due = phases_.is_due(every());
  switch (phases_.now()) {
    case Phase::drop:
      if (due) decide_drop();
      return;
    case Phase::compress:
      if (due) decide_compression();
      return;
    case Phase::rest:
    case Phase::settle:
      if (due && periodic() && is_led_now()) lead();
      if (phases_.is_due(kCheckEvery)) decide_rest();
      return;
    case Phase::precompress:
      if (phases_.steps() == next_record_) {
        begin(plan_.settle == "rest" ? Phase::settle : after(Phase::settle));
      }
      return;
    case Phase::deform:
    case Phase::unload:
      return decide_deformation();
    case Phase::probe_prepared:
    case Phase::probe_first:
    case Phase::done:
      return;
  }
}

void SampleRun::decide_deformation() {
  const Phase before = phases_.now();
  const bool due = phases_.is_due(every());
  if (before == Phase::unload && plan_.unload == "stress") {
    if (due && pressure()[last()] <= unloading_level()) {
      record();
    } else if (phases_.steps() == next_record_) {
      throw ComputationFailed(fmt::format(
          "the axial stress is still above {:.4g} after the deformation has been taken back twice; "
          "raise sample.unload_stress",
          unloading_level()));
    }
  } else if (phases_.steps() == next_record_) {
    record();
  }
  if (done() || !due || phases_.now() != before) return;
  if (periodic()) {
    if (is_led_now()) lead();
    return;
  }
  if (tilts(plan_)) {
    tilt_sides(*engine_, plan_, strain(kTiltEvery), kTiltEvery);
  }
  if (is_led_now() && phases_.is_due(kCheckEvery)) note_error();
}

// At rest on the floor: the lid is put on, the gap filled, gravity taken away.
void SampleRun::decide_drop() {
  const Diagnostics d = engine_->measure();
  if (d.contacts == 0 || !at_rest(d, setup_.rest)) {
    if (in_phase() > setup_.rest.max_time) {
      fail_to_rest(d, setup_.rest, "dropped into the box", ", or change sample.drop_damping");
    }
    return;
  }
  Random random(seed_ ^ kGapSeed);
  go_on_from(put_lid_on(engine_->snapshot(), plan_, setup_.material.density, random));
}

void SampleRun::decide_compression() {
  if (!compresses_to_pressure(plan_)) {
    if (compressed() >= 1) begin(Phase::rest);
    return;
  }
  if (periodic()) lead();
  if (is_near_pressure(plan_, pressure())) return begin(Phase::rest);
  check_pressure_found(setup_, in_phase(), compression_time_, fraction());
}

// What follows a phase of the preparation: the next one that the plan asks for.
Phase SampleRun::after(Phase phase) const {
  if (phase == Phase::rest && probes_prepared(plan_)) return Phase::probe_prepared;
  if (phase <= Phase::probe_prepared && precompresses(plan_)) return Phase::precompress;
  return phase < Phase::probe_first && probes_first(plan_) ? Phase::probe_first : Phase::deform;
}

void SampleRun::decide_rest() {
  const Diagnostics d = engine_->measure();
  const bool led = is_led_now();
  const Vec3 held = led ? pressure() : Vec3::Zero();
  if (is_prepared(setup_, phases_.now(), d, held)) return begin(after(phases_.now()));
  if (in_phase() > setup_.rest.max_time) fail_to_prepare(setup_, d, held);
}

void SampleRun::probe(long steps) {
  if (prober_.decide(engine_, steps, [this] { return empty_engine(); }))
    begin(after(phases_.now()));
}

// The motion of cell or walls at the beginning of a phase; of a cell's servo at every measurement.
void SampleRun::lead() {
  const Phase now = phases_.now();
  if (periodic()) {
    const bool led = is_led_now();
    if (led && deforms(now)) note_error();
    engine_->set_velocity_gradient(
        cell_flow(plan_, now, led ? pressure() : Vec3::Zero(), led ? fraction() : 0, cell_servo_));
    return;
  }
  Vec3 first = Vec3::Zero();
  if (!states_.empty()) first = sample_state(*states_.front()).edges.diagonal();
  lead_walls(*engine_, plan_, now, box_, first);
  if (deforms(now) && tilts(plan_)) {
    tilt_sides(*engine_, plan_, strain(kTiltEvery), kTiltEvery);
  }
}

void SampleRun::note_error() {
  const double error = servo_error(plan_, phases_.now(), pressure());
  stress_error_ = std::max(stress_error_, error);
  squared_errors_ += error * error;
  ++measured_;
}

void SampleRun::record() {
  if (is_led_now()) note_error();
  const std::size_t number = states_.size();
  const double now = number == 0 ? 0 : strain();
  check_not_crushed(setup_, engine_->measure(), fmt::format("at a strain of {:.3g}", now),
                    "strain");
  states_.emplace_back(sample_record(*engine_, plan_, number, now, seed_));
  if (number == 0) {
    for (const StateProbes& probes : prober_.found()) put_probes(probes, *states_.front());
  }
  const auto count = static_cast<int>(states_.size());
  if (count == states_of(plan_)) return begin(Phase::done);
  if (count == plan_.records + 1) return begin(Phase::unload);
  plan_next_record();
}

void SampleRun::plan_next_record() {
  const auto count = static_cast<int>(states_.size());
  const double step = engine_->time_step();
  if (phases_.now() == Phase::deform) {
    next_record_ = steps_to(plan_, plan_.strain * static_cast<double>(count) / plan_.records, step);
    return;
  }
  const double back = plan_.unload == "stress"
                          ? 2
                          : plan_.unload_strain * (count - plan_.records) / plan_.unload_records;
  next_record_ = steps_to(plan_, plan_.strain * back, step);
}

// Axial stress of the next state of an unloading to a stress: equal steps from the last state of
// the loading to the share of the first state's, or to kLeastUnloaded.
double SampleRun::unloading_level() const {
  const auto axial = [&](std::size_t state) {
    const SampleState s = sample_state(*states_[state]);
    return periodic() ? -s.stress(last(), last()) : s.moved_pressure[last()];
  };
  const double most = axial(static_cast<std::size_t>(plan_.records));
  const double least = std::max(plan_.unload_stress * axial(0), kLeastUnloaded * most);
  const double share =
      static_cast<double>(static_cast<int>(states_.size()) - plan_.records) / plan_.unload_records;
  return most + share * (least - most);
}

double SampleRun::share(const Diagnostics& state) const {
  switch (phases_.now()) {
    case Phase::compress:
      return compresses_to_pressure(plan_) ? fraction() / (plan_.dim == 2 ? kDense2 : kDense3)
                                           : compressed();
    case Phase::drop:
    case Phase::rest:
    case Phase::settle:
      return rest_progress(state, setup_.rest);
    case Phase::probe_prepared:
    case Phase::probe_first:
      return prober_.share();
    case Phase::precompress:
      return strain_at(plan_, in_phase()) / plan_.precompression;
    case Phase::deform:
      return strain() / plan_.strain;
    case Phase::unload:
      return static_cast<double>(static_cast<int>(states_.size()) - plan_.records - 1) /
             plan_.unload_records;
    case Phase::done:
      break;
  }
  return 1;
}

void SampleRun::visit(Archive& archive) {
  phases_.visit(archive);
  archive(stress_error_);
  archive(squared_errors_);
  archive(measured_);
  if (is_dropped(plan_)) {
    archive(box_);
    archive(solid_volume_);
    archive(dropped_fraction_);
    archive(gap_spheres_);
  }
  archive(next_record_);
  cell_servo_.visit(archive);
  prober_.visit(archive);
  visit_engine(archive);
  auto count = static_cast<int>(states_.size());
  archive(count);
  archive.require(count >= 0 && count <= states_of(plan_) &&
                  (phases_.now() < Phase::deform) == (count == 0) &&
                  (phases_.now() < Phase::unload) == (count <= plan_.records) &&
                  done() == (count == states_of(plan_)));
  states_.resize(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < states_.size(); ++k) {
    archive.snapshot(states_[k], state_name(k));
    archive.require(states_[k].has_value());
  }
}

std::string SampleRun::fingerprint() const {
  return fmt::format("{} {}", PhasedRun::fingerprint(), filled_from_);
}

RunResult SampleRun::result() const {
  RunResult out;
  if (!done()) return out;
  for (std::size_t k = 0; k < states_.size(); ++k)
    out.snapshots.emplace_back(state_name(k), *states_[k]);
  add_engine_figures(*engine_, engine_->measure(), out.figures);
  if (is_dropped(plan_)) {
    out.figures["sample.gap_spheres"] = gap_spheres_;
    out.figures["sample.dropped_solid_fraction"] = dropped_fraction_;
  }
  if (any_led(plan_, Phase::deform)) {
    out.figures["sample.stress_error"] = stress_error_;
    out.figures["sample.stress_rms_error"] =
        std::sqrt(squared_errors_ / static_cast<double>(measured_));
  }
  return out;
}

}  // namespace

std::unique_ptr<Run> make_sample_run(const SampleSetup& setup, std::uint64_t seed, int threads,
                                     const Snapshot* filled) {
  return std::make_unique<SampleRun>(setup, seed, threads, filled);
}

}  // namespace grainfield::dem
