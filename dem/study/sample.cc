// Grains placed loosely are compressed, rest, and are deformed:
//   compress -> rest -> snapshot "state_000" -> deform, with a snapshot at equal steps of strain.
// A periodic cell is led by its velocity gradient, between walls by their motion; where a stress is
// held, by CellServo here and by the engine's servos there.
#include "dem/study/sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "dem/study/cell_servo.h"
#include "dem/study/fingerprint.h"
#include "dem/study/phases.h"
#include "dem/study/sample_checks.h"
#include "dem/study/sample_servo.h"
#include "dem/study/sample_state.h"
#include "dem/walls/box.h"

namespace grainfield::dem {
namespace {

// Steps between two decisions: of the compression and of a cell's servo; of sides that tilt; else.
constexpr long kServoEvery = 3, kTiltEvery = 100, kCheckEvery = 200;
// A compression to a pressure ends at this share of it; what is left comes in the rest. At rest it
// is met within the second.
constexpr double kNearTarget = 0.9, kMet = 2e-3;
// More than grains can fill: they would be inside each other.
constexpr double kTooDense = 1.3;
// Below these no packing carries load (random loose ones of round grains: 0.77, 0.55) ...
constexpr double kLoose2 = 0.7, kLoose3 = 0.5;
// ... and near these, about, pressures are reached; for the progress.
constexpr double kDense2 = 0.84, kDense3 = 0.64;

enum class Phase : int { compress, rest, deform, done };

class SampleRun final : public ArchivedRun {
 public:
  SampleRun(const SampleSetup& setup, std::uint64_t seed, int threads);

  void advance(long steps) override;
  bool done() const override { return phases_.done(); }
  Progress progress() const override;
  RunResult result() const override;

 private:
  int last() const { return plan_.dim - 1; }
  bool periodic() const { return plan_.boundary == "periodic"; }
  bool to_pressure() const { return plan_.compress_to == "pressure"; }
  bool shears() const { return plan_.deformation == "simple_shear"; }
  bool tilts() const { return shears() && !periodic() && plan_.sides == "tilting"; }
  /// Whether the axis' edge changes in the compression, and whether a servo leads it in a phase.
  bool compresses(int axis) const { return plan_.compression == "isotropic" || axis == last(); }
  bool is_led(Phase phase, int axis) const;
  bool any_led(Phase phase) const;
  long every() const;
  double in_phase() const { return static_cast<double>(phases_.steps()) * engine_->time_step(); }
  Cell<3> cell_at_start() const;
  std::unique_ptr<Engine> empty_engine() const;
  /// Of each axis, m; without looking at a contact in a cell.
  Vec3 edges() const;
  double compressed() const;

  void begin(Phase phase);
  void decide();
  void decide_compression();
  void decide_rest();
  void lead_cell();
  void lead_walls();
  WallServo servo(int axis) const;
  void tilt_sides();
  /// Along each axis, what servos hold: the pressure in a cell, that on the walls that move. Pa.
  Vec3 pressure() const;
  double solid_fraction() const;
  double worst_error() const;
  void note_error();
  void record();
  std::string name_of(std::size_t state) const { return fmt::format("state_{:03}", state); }
  void visit(Archive& archive) override;
  std::string fingerprint() const override;

  SampleSetup setup_;
  const SamplePlan& plan_ = setup_.plan;
  std::uint64_t seed_;
  EngineSettings settings_;
  std::array<double, 3> box_{};  // edges at the start, m
  double solid_volume_ = 0;      // of all grains, m3 (m2)
  double compression_time_ = 0;  // s, at least
  CellServo cell_servo_;
  Phases<Phase> phases_{{{"compress", true, 0, 0.3},
                         {"rest", true, 0.3, 0.4},
                         {"deform", false, 0.4, 1},
                         {"done", false, 1, 1}}};
  std::unique_ptr<Engine> engine_;
  long next_record_ = 0;  // steps of the deformation; follows from the states
  // Of the servos in the deformation: largest error, sum of squares, and how often measured.
  double stress_error_ = 0, squared_errors_ = 0;
  std::int64_t measured_ = 0;
  std::vector<std::optional<Snapshot>> states_;
};

const char* moved_wall(int axis, int dim) {
  return axis == dim - 1 ? "lid" : axis == 0 ? "right" : "back";
}

SampleRun::SampleRun(const SampleSetup& setup, std::uint64_t seed, int threads)
    : setup_(setup), seed_(seed) {
  check_sample(setup_);
  Random random(seed);
  const double density = setup_.material.density;
  const std::vector<ShapedGrain> grains = draw_sample(plan_, random);
  const SampleFrame frame = sample_frame(setup_, sample_extremes(plan_, density, grains));
  settings_ = frame.settings;
  compression_time_ = frame.compression_time;
  settings_.threads = threads;
  solid_volume_ = total_area(grains);
  box_ = sample_box(plan_, solid_volume_);
  settings_.cell = cell_at_start();

  cell_servo_ = cell_servo_for(setup_, settings_);
  cell_servo_.interval = kServoEvery * settings_.time_step;

  engine_ = empty_engine();
  for (const NewGrain& grain : place_sample(plan_, grains, box_, density, random)) {
    engine_->add(grain);
  }
  begin(Phase::compress);
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

std::unique_ptr<Engine> SampleRun::empty_engine() const {
  std::unique_ptr<Engine> engine = make_engine(settings_);
  if (periodic()) return engine;
  Vec3 high(box_[0], box_[1], box_[2]);
  if (plan_.dim == 2) high.z() = 0;
  for (const Wall& wall : box_walls(Vec3::Zero(), high, setup_.material.wall_friction, plan_.dim)) {
    engine->add_wall(wall);
  }
  return engine;
}

bool SampleRun::is_led(Phase phase, int axis) const {
  if (phase == Phase::deform) {
    if (plan_.deformation == "axial") return axis != last();
    return shears() && plan_.constant == "stress" && axis == last();
  }
  return to_pressure() && compresses(axis);
}

bool SampleRun::any_led(Phase phase) const {
  for (int a = 0; a < plan_.dim; ++a) {
    if (is_led(phase, a)) return true;
  }
  return false;
}

long SampleRun::every() const {
  const Phase now = phases_.now();
  if (now == Phase::compress || (periodic() && any_led(now))) return kServoEvery;
  return now == Phase::deform && tilts() ? kTiltEvery : kCheckEvery;
}

void SampleRun::advance(long steps) {
  while (steps > 0 && !done()) {
    long chunk = std::min(steps, phases_.until_due(every()));
    if (phases_.now() == Phase::deform) chunk = std::min(chunk, next_record_ - phases_.steps());
    engine_->step(chunk);
    phases_.advance(chunk);
    steps -= chunk;
    decide();
  }
}

void SampleRun::begin(Phase phase) {
  phases_.enter(phase);
  engine_->set_background_damping(phases_.info().damped ? setup_.rest.background_damping : 0);
  cell_servo_.forget();
  if (phase == Phase::deform) record();
  if (phase == Phase::done) return;
  if (periodic()) {
    lead_cell();
  } else {
    lead_walls();
  }
}

void SampleRun::decide() {
  const bool due = phases_.is_due(every());
  switch (phases_.now()) {
    case Phase::compress:
      if (due) decide_compression();
      return;
    case Phase::rest:
      if (due && periodic() && any_led(Phase::rest)) lead_cell();
      if (phases_.is_due(kCheckEvery)) decide_rest();
      return;
    case Phase::deform:
      if (phases_.steps() == next_record_) record();
      if (done() || !due) return;
      if (periodic()) {
        if (any_led(Phase::deform)) lead_cell();
      } else {
        if (tilts()) tilt_sides();
        if (any_led(Phase::deform) && phases_.is_due(kCheckEvery)) {
          note_error();
        }
      }
      return;
    case Phase::done:
      return;
  }
}

Vec3 SampleRun::edges() const {
  Vec3 edges = Vec3::Zero();
  if (periodic()) {
    const Cell<3> cell = engine_->cell();
    for (int a = 0; a < plan_.dim; ++a) edges[a] = cell.edges(a, a);
    return edges;
  }
  const std::vector<Wall> walls = engine_->walls();
  for (int a = 0; a < plan_.dim; ++a) {
    const auto there = [&](std::size_t k) { return walls[k].point[a]; };
    const auto first = static_cast<std::size_t>(2 * a);  // box_walls: pairs, axis by axis
    edges[a] = there(first + 1) - there(first);
  }
  return edges;
}

// Share of its target that the compression has reached, but for a pressure.
double SampleRun::compressed() const {
  if (plan_.compress_to == "strain") {
    return (1 - edges()[last()] / box_[last()]) / plan_.compression_strain;
  }
  return solid_fraction() / plan_.solid_fraction;
}

void SampleRun::decide_compression() {
  if (!to_pressure()) {
    if (compressed() >= 1) begin(Phase::rest);
    return;
  }
  if (periodic()) lead_cell();
  const Vec3 now = pressure();
  bool near = true;
  for (int a = 0; a < plan_.dim; ++a) {
    near = near && (!is_led(Phase::compress, a) || now[a] >= kNearTarget * plan_.pressure);
  }
  if (near) return begin(Phase::rest);
  const double most = 2 * compression_time_ + setup_.rest.max_time;
  if (in_phase() > most) {
    throw ComputationFailed(fmt::format(
        "sample.pressure = {:g} has not been reached within {:.3g} s (twice the way at "
        "sample.compression_rate, and rest.max_time): the lower it is beside the contacts' "
        "stiffness, the slower it is found; raise it, or rest.max_time",
        plan_.pressure, most));
  }
  if (solid_fraction() > kTooDense) {
    throw ComputationFailed(
        fmt::format("the sample has been compressed to a solid fraction of {:.3g} without reaching "
                    "sample.pressure = {:g}; lower it, or raise the stiffness (material)",
                    solid_fraction(), plan_.pressure));
  }
}

void SampleRun::decide_rest() {
  const Diagnostics d = engine_->measure();
  if (at_rest(d, setup_.rest) && (!any_led(Phase::rest) || worst_error() <= kMet)) {
    return begin(Phase::deform);
  }
  if (in_phase() <= setup_.rest.max_time) return;
  if (d.contacts == 0) {
    throw ComputationFailed(fmt::format(
        "no grain touches another after rest.max_time = {:g} s: the sample is too loose to be "
        "sheared; raise sample.{}",
        setup_.rest.max_time,
        plan_.compress_to == "strain" ? "compression_strain" : "solid_fraction"));
  }
  if (at_rest(d, setup_.rest)) {
    const Vec3 now = pressure();
    throw ComputationFailed(fmt::format(
        "sample.pressure = {:g} has not been met within rest.max_time = {:g} s: the grains rest at "
        "pressures of {:.4g} along x and {:.4g} along {}; raise it, or lower "
        "sample.compression_rate",
        plan_.pressure, setup_.rest.max_time, now[0], now[last()], plan_.dim == 2 ? "y" : "z"));
  }
  fail_to_rest(d, setup_.rest, "after the compression",
               to_pressure() ? ", or lower sample.compression_rate"
                             : ", or compress further: a sample below jamming carries no stress");
}

// The flow of the cell: what is prescribed, and what the servo asks for.
void SampleRun::lead_cell() {
  const Phase now = phases_.now();
  Eigen::Matrix3d flow = Eigen::Matrix3d::Zero();
  if (now == Phase::compress) {
    for (int a = 0; a < plan_.dim; ++a) {
      if (compresses(a)) flow(a, a) = -plan_.compression_rate;
    }
  } else if (now == Phase::deform) {
    if (shears()) {
      flow(0, last()) = plan_.strain_rate;
    } else {
      flow(last(), last()) = -plan_.strain_rate;
    }
    if (plan_.deformation == "isotropic") {
      for (int a = 0; a < last(); ++a) flow(a, a) = -plan_.strain_rate;
    }
  }
  if (any_led(now)) {
    if (now == Phase::deform) note_error();
    const Vec3 held = pressure();
    const bool loose = solid_fraction() < (plan_.dim == 2 ? kLoose2 : kLoose3);
    for (int a = 0; a < plan_.dim; ++a) {
      if (!is_led(now, a)) continue;
      // Without contacts there is nothing that a servo could go by.
      const bool free = now == Phase::compress && loose && held[a] < plan_.pressure;
      flow(a, a) = free ? -plan_.compression_rate : cell_servo_.rate(a, held[a], plan_.pressure);
    }
  }
  engine_->set_velocity_gradient(flow);
}

WallServo SampleRun::servo(int axis) const {
  WallServo servo;
  servo.stress = plan_.pressure;
  servo.max_speed = plan_.compression_rate * box_[axis];
  if (phases_.now() == Phase::deform && shears()) {  // between sides that tilt
    const Vec3 now = edges();
    servo.area = plan_.dim == 2 ? now[0] : now[0] * now[1];
    return servo;
  }
  for (int a = 0; a < plan_.dim; ++a) {
    if (a == axis) continue;
    const char* fixed = a == last() ? "floor" : a == 0 ? "left" : "front";
    servo.between.push_back({fixed, moved_wall(a, plan_.dim)});
  }
  return servo;
}

// The walls' motion at the beginning of a phase.
void SampleRun::lead_walls() {
  const Phase now = phases_.now();
  const Vec3 size = edges();
  for (int a = 0; a < plan_.dim; ++a) {
    WallMotion motion;
    Vec3 inwards = Vec3::Zero();
    inwards[a] = -size[a];
    if (is_led(now, a)) {
      motion.servo = servo(a);
    } else if (now == Phase::compress) {
      if (compresses(a)) motion.velocity = plan_.compression_rate * inwards;
    } else if (now == Phase::deform) {
      const bool moves = plan_.deformation == "isotropic" || (!shears() && a == last());
      if (moves) motion.velocity = plan_.strain_rate * inwards;
      motion.ramp = plan_.ramp_time;
    }
    if (now == Phase::deform && shears() && a == last()) {
      motion.velocity.x() = plan_.strain_rate * size[last()];
      motion.ramp = plan_.ramp_time;
    }
    // A servo that goes on keeps what it has learnt.
    const bool goes_on = now == Phase::rest || (now == Phase::deform && !shears());
    if (is_led(now, a) && goes_on) continue;
    engine_->set_wall_motion(moved_wall(a, plan_.dim), motion);
  }
  if (now == Phase::deform && tilts()) tilt_sides();
}

// Turns left and right about their feet, so that they have the tilt of the strain at the next
// turn.
void SampleRun::tilt_sides() {
  const double dt = engine_->time_step();
  const double then = strain_at(plan_, in_phase() + kTiltEvery * dt);
  for (const Wall& wall : engine_->walls()) {
    if (wall.name != "left" && wall.name != "right") continue;
    // The angle between the tangents, by its series: it is small.
    const double now = -wall.normal[last()] / wall.normal.x();
    const double t = (then - now) / (1 + now * then), q = t * t;
    const double angle = t * (1 - q * (1.0 / 3 - q * (1.0 / 5 - q / 7)));
    WallMotion motion;
    Vec3 foot = wall.point;
    foot.x() -= now * wall.point[last()];  // the floor is at 0
    foot[last()] = 0;
    motion.centre = foot;
    const double spin = angle / (kTiltEvery * dt);
    if (plan_.dim == 2) {
      motion.angular_velocity.z() = -spin;
    } else {
      motion.angular_velocity.y() = spin;
    }
    engine_->set_wall_motion(wall.name, motion);
  }
}

Vec3 SampleRun::pressure() const {
  if (periodic()) return -engine_->cell_stress().total().diagonal();
  Snapshot walls;
  walls.dim = plan_.dim;
  walls.walls = engine_->walls();
  return sample_state(walls).moved_pressure;
}

double SampleRun::solid_fraction() const {
  const Vec3 now = edges();
  double volume = 1;
  for (int a = 0; a < plan_.dim; ++a) volume *= now[a];
  return solid_volume_ / volume;
}

// Largest relative error of what servos hold now.
double SampleRun::worst_error() const {
  const Vec3 held = pressure();
  double worst = 0;
  for (int a = 0; a < plan_.dim; ++a) {
    if (is_led(phases_.now(), a)) worst = std::max(worst, std::fabs(held[a] / plan_.pressure - 1));
  }
  return worst;
}

void SampleRun::note_error() {
  const double error = worst_error();
  stress_error_ = std::max(stress_error_, error);
  squared_errors_ += error * error;
  ++measured_;
}

void SampleRun::record() {
  Snapshot s = engine_->snapshot();
  if (any_led(Phase::deform)) note_error();
  const Diagnostics d = engine_->measure();
  const auto put = [&](const char* name, double value) {
    s.attributes[name] = fmt::format("{:.17g}", value);
  };
  const std::size_t number = states_.size();
  s.attributes["state"] = name_of(number);
  s.attributes["seed"] = fmt::format("{}", seed_);
  s.attributes["boundary"] = plan_.boundary;
  s.attributes["deformation"] = plan_.deformation;
  put("strain", number == 0 ? 0 : strain_at(plan_, in_phase()));
  put("strain_rate", plan_.strain_rate);
  put("kinetic_energy", d.kinetic_energy);
  put("elastic_energy", d.elastic_energy);
  put("work", d.cell_work + d.wall_work);
  put("unbalanced_force_ratio", d.unbalanced_force_ratio);
  if (d.energy_followed) {
    put("lost_in_dashpots", d.contact_losses.dashpot);
    put("lost_to_friction", d.contact_losses.friction);
    put("lost_to_rolling", d.contact_losses.rolling);
    put("lost_to_damping", d.damped_energy);
    put("work_of_law", d.contact_losses.law);
    put("energy_balance", d.energy_balance());
  }
  states_.emplace_back(std::move(s));
  const auto records = static_cast<std::size_t>(plan_.records);
  if (states_.size() > records) return begin(Phase::done);
  next_record_ = steps_to(plan_, plan_.strain * static_cast<double>(states_.size()) / plan_.records,
                          engine_->time_step());
}

Progress SampleRun::progress() const {
  const Diagnostics d = engine_->measure();
  Progress p;
  p.phase = phases_.info().name;
  double share = 1;
  switch (phases_.now()) {
    case Phase::compress:
      share =
          to_pressure() ? solid_fraction() / (plan_.dim == 2 ? kDense2 : kDense3) : compressed();
      break;
    case Phase::rest:
      share = rest_progress(d, setup_.rest);
      break;
    case Phase::deform:
      share = strain_at(plan_, in_phase()) / plan_.strain;
      break;
    case Phase::done:
      break;
  }
  p.fraction = done() ? 1 : phases_.fraction(share);
  p.simulated_time = engine_->time();
  p.steps = engine_->steps();
  p.grains = engine_->grains();
  p.awake = d.awake;
  p.kinetic_energy = d.kinetic_energy;
  p.unbalanced_force_ratio = d.unbalanced_force_ratio;
  return p;
}

void SampleRun::visit(Archive& archive) {
  phases_.visit(archive);
  archive(stress_error_);
  archive(squared_errors_);
  archive(measured_);
  archive(next_record_);
  cell_servo_.visit(archive);
  archive.engine(engine_, [this] { return empty_engine(); });
  auto count = static_cast<int>(states_.size());
  archive(count);
  archive.require(count >= 0 && count <= plan_.records + 1 &&
                  (phases_.now() < Phase::deform) == (count == 0) &&
                  done() == (count == plan_.records + 1));
  states_.resize(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < states_.size(); ++k) {
    archive.snapshot(states_[k], name_of(k));
    archive.require(states_[k].has_value());
  }
}

std::string SampleRun::fingerprint() const {
  return fmt::format("sample {} {} {}", fingerprint_of(setup_), settings_.time_step, seed_);
}

RunResult SampleRun::result() const {
  RunResult out;
  if (!done()) return out;
  for (std::size_t k = 0; k < states_.size(); ++k)
    out.snapshots.emplace_back(name_of(k), *states_[k]);
  add_engine_figures(*engine_, engine_->measure(), out.figures);
  if (any_led(Phase::deform)) {
    out.figures["sample.stress_error"] = stress_error_;
    out.figures["sample.stress_rms_error"] =
        std::sqrt(squared_errors_ / static_cast<double>(measured_));
  }
  return out;
}

}  // namespace

std::unique_ptr<Run> make_sample_run(const SampleSetup& setup, std::uint64_t seed, int threads) {
  return std::make_unique<SampleRun>(setup, seed, threads);
}

}  // namespace grainfield::dem
