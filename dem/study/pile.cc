// A sand pile (Roul ch. 3): pour -> settle -> rest with every grain awake -> snapshot "pile" ->
// changes of gravity -> "gravity_G".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "dem/heap/source.h"
#include "dem/study/common.h"
#include "dem/study/gravity_changes.h"
#include "dem/study/pile_checks.h"
#include "dem/study/pile_figures.h"
#include "dem/study/run.h"

namespace grainfield::dem {
namespace {

// Share of a run with changes of gravity at which the pile is at rest, for the progress.
constexpr double kEndOfRest = 0.85;
// Rest and settling are judged every so many steps, counted within a phase.
constexpr long kCheckEvery = 200;
// While grains are poured the number awake is read this often: it looks at every contact.
constexpr long kSampleEvery = 3000;
// A grain out of the funnel joins the simulation this many mean diameters above the pile, ...
constexpr double kEntryMargin = 10;
// ... or this many steps later when a grain that has bounced up there is in its place.
constexpr long kRetryEvery = 10;
// Settled: mean kinetic energy of the grains that moved last below this share of m g r.
constexpr double kSettledShare = 0.01;
// ... but at most this, s, for a layer and for the whole pile.
constexpr double kMaxSettleTime = 2;
// Diameters: what is lower than this below the plateau's middle belongs to the flanks. A plateau
// shorter than kPoint diameters is the pile's point.
constexpr double kPlateauDrop = 1.5, kPoint = 3;

enum class Phase : int { pour, settle, rest, change, done };

class PileRun final : public Run {
 public:
  PileRun(const PileSetup& setup, std::uint64_t seed, int threads);

  void advance(long steps) override;
  bool done() const override { return phase_ == Phase::done; }
  Progress progress() const override;
  void save(const std::string& file) const override;
  void restore(const std::string& file) override;
  RunResult result() const override;

 private:
  // A grain out of the funnel on its way down.
  struct Flight {
    long step = 0;  // at which it joins the simulation
    int grain = 0;
    int pad = 0;
    double x = 0;
  };

  void draw();
  std::unique_ptr<Engine> empty_engine() const;
  void add_floor_grains();
  void enter(Phase phase);
  long next_event() const;
  void act();
  void pour_point();
  void pour_line();
  void release_grain();
  bool join(const Flight& flight);
  void drop_layer();
  void end_pour();
  void settle();
  void rest();
  void change(long steps);
  bool settled(int grains) const;
  double in_phase() const { return static_cast<double>(phase_steps_) * engine_->time_step(); }
  Snapshot named(Snapshot snapshot, const std::string& state) const;
  std::string fingerprint() const;

  PileSetup setup_;
  std::uint64_t seed_;
  Random random_;
  std::vector<ShapedGrain> grains_, floor_;  // drawn before anything moves
  double largest_diameter_ = 0, mean_diameter_ = 0;
  EngineSettings settings_;
  std::optional<PointSource> point_;
  std::unique_ptr<Engine> engine_;

  Phase phase_ = Phase::pour;
  long phase_steps_ = 0;
  int poured_ = 0;  // released by the point source, dropped by the line source
  double top_ = 0;  // of the grains at rest when the last one joined, m
  std::deque<Flight> in_flight_;
  Stretch line_;          // of the last layer
  long layer_start_ = 0;  // step within the phase
  int layer_grains_ = 0;
  double awake_sum_ = 0;
  long awake_samples_ = 0;
  double pour_time_ = 0;
  Diagnostics at_pile_;  // when the pile was at rest
  std::optional<Snapshot> pile_;
  std::optional<GravityChanges> changes_;
};

PileRun::PileRun(const PileSetup& setup, std::uint64_t seed, int threads)
    : setup_(setup), seed_(seed), random_(seed) {
  check_pile(setup_);
  draw();
  std::vector<ShapedGrain> all = grains_;
  all.insert(all.end(), floor_.begin(), floor_.end());
  settings_ =
      engine_settings(setup_.material, setup_.motion, extremes_of(all, setup_.material.density),
                      threads, setup_.shape.kind == "rand1" || setup_.shape.kind == "irregular");
  check_source(setup_, grains_);
  settings_.polygons = setup_.shape.kind != "disk";
  const SleepSetup& s = setup_.sleep;
  settings_.sleep = {s.on, s.quiet_time, s.quiet_move, s.quiet_force, s.wake_force, s.wake_speed};
  engine_ = empty_engine();
  add_floor_grains();
  point_.emplace(setup_.source, setup_.material.gravity, settings_.time_step);
  line_ = {-0.5 * setup_.source.length, 0.5 * setup_.source.length};
  changes_.emplace(setup_.change, setup_.rest, settings_, smaller_step(setup_.motion));
}

void PileRun::draw() {
  for (int k = 0; k < setup_.source.grains; ++k) {
    grains_.push_back(draw_grain(setup_.shape, random_));
  }
  largest_diameter_ = 2 * largest_radius(grains_);
  mean_diameter_ = 2 * mean_radius(grains_);
  if (setup_.floor.kind != "rough") return;
  for (double room = setup_.floor.length;;) {
    const ShapedGrain next = draw_grain(setup_.shape, random_);
    room -= 2 * next.radius;
    if (room < 0) return;
    floor_.push_back(next);
  }
}

std::unique_ptr<Engine> PileRun::empty_engine() const {
  std::unique_ptr<Engine> engine = make_engine(settings_);
  const double half = 0.5 * setup_.floor.length;
  // Below a rough floor's grains the plane is out of reach.
  const double depth = floor_.empty() ? 0 : 4 * largest_radius(floor_);
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
  for (const ShapedGrain& g : floor_) slack -= 2 * g.radius;
  const double gap = floor_.empty() ? 0 : slack / static_cast<double>(floor_.size());
  double x = -half;
  for (const ShapedGrain& shaped : floor_) {
    NewGrain g = shaped.at(x + 0.5 * gap + shaped.radius, -shaped.radius, setup_.material.density);
    g.fixed = true;
    engine_->add(g);
    x += 2 * shaped.radius + gap;
  }
}

void PileRun::enter(Phase phase) {
  phase_ = phase;
  phase_steps_ = 0;
  const bool damped = phase != Phase::pour && phase != Phase::settle;
  engine_->set_background_damping(damped ? setup_.rest.background_damping : 0);
}

void PileRun::advance(long steps) {
  while (phase_ != Phase::done) {
    if (phase_ == Phase::change) {
      change(steps);
      return;
    }
    const long next = next_event();
    if (next > phase_steps_) {
      if (steps <= 0) return;
      const long chunk = std::min(steps, next - phase_steps_);
      engine_->step(chunk);
      phase_steps_ += chunk;
      steps -= chunk;
    }
    if (phase_steps_ >= next) act();
  }
}

// The step, within the phase, at which something is decided. act() moves it on.
long PileRun::next_event() const {
  const auto after = [this](long every) { return (phase_steps_ / every + 1) * every; };
  if (phase_ != Phase::pour || setup_.source.kind == "line") {
    return phase_ == Phase::pour && poured_ == 0 ? phase_steps_ : after(kCheckEvery);
  }
  long next = (awake_samples_ + 1) * kSampleEvery;
  if (poured_ < setup_.source.grains) next = std::min(next, point_->release_step(poured_));
  if (!in_flight_.empty()) next = std::min(next, in_flight_.front().step);
  return next;
}

void PileRun::act() {
  switch (phase_) {
    case Phase::pour:
      return setup_.source.kind == "line" ? pour_line() : pour_point();
    case Phase::settle:
      return settle();
    case Phase::rest:
      return rest();
    case Phase::change:
    case Phase::done:
      return;
  }
}

void PileRun::pour_point() {
  if (!in_flight_.empty() && in_flight_.front().step <= phase_steps_) {
    if (join(in_flight_.front())) {
      in_flight_.pop_front();
    } else {
      in_flight_.front().step = phase_steps_ + kRetryEvery;
    }
  }
  if (poured_ < setup_.source.grains && point_->release_step(poured_) == phase_steps_) {
    release_grain();
  }
  if (phase_steps_ == (awake_samples_ + 1) * kSampleEvery) {
    awake_sum_ += engine_->motion().awake;
    ++awake_samples_;
  }
  if (poured_ == setup_.source.grains && in_flight_.empty()) end_pour();
}

void PileRun::release_grain() {
  check_mouth(setup_, top_, largest_diameter_);
  Flight f;
  f.grain = poured_;
  f.x =
      point_->axis(poured_) + setup_.source.spread * 0.5 * mean_diameter_ * random_.uniform(-1, 1);
  const double entry = top_ + kEntryMargin * mean_diameter_ + grains_[poured_].radius;
  f.step = point_->arrival_step(poured_, entry);
  // One after the other, and not before those that are to join at this very step.
  if (!in_flight_.empty()) f.step = std::max(f.step, in_flight_.back().step + 1);
  f.step = std::max(f.step, phase_steps_ + 1);
  in_flight_.push_back(f);
  ++poured_;
}

// False when another grain is there.
bool PileRun::join(const Flight& f) {
  const ShapedGrain& shaped = grains_[f.grain];
  NewGrain g = shaped.at(f.x, 0, setup_.material.density);
  point_->place(g, f.grain, phase_steps_);
  const Snapshot now = engine_->snapshot();
  for (const Grain& other : now.grains) {
    if (std::hypot(other.position.x() - g.x, other.position.y() - g.y) < other.radius + g.radius) {
      return false;
    }
  }
  top_ = resting_top(now);
  check_walls_free(setup_, now, largest_diameter_,
                   static_cast<double>(f.grain + 1) / setup_.source.grains);
  engine_->add(g);
  return true;
}

void PileRun::pour_line() {
  if (poured_ > 0) {
    awake_sum_ += engine_->motion().awake;
    ++awake_samples_;
    const double fall =
        std::sqrt(2 * (setup_.source.clearance + largest_diameter_) / setup_.material.gravity);
    const double since = static_cast<double>(phase_steps_ - layer_start_) * engine_->time_step();
    if (since < 1.5 * fall) return;
    if (!settled(layer_grains_) && since < kMaxSettleTime) return;
  }
  if (poured_ == setup_.source.grains) {
    end_pour();
  } else {
    drop_layer();
  }
}

void PileRun::drop_layer() {
  double bottom = setup_.source.clearance;
  if (poured_ > 0) {
    const Snapshot now = engine_->snapshot();
    check_walls_free(setup_, now, largest_diameter_,
                     static_cast<double>(poured_) / setup_.source.grains);
    const Surface surface = free_surface(now, mean_diameter_);
    const double plateau = plateau_of(surface, line_, kPlateauDrop * mean_diameter_).length();
    const double middle = 0.5 * (line_.left + line_.right) + setup_.source.shift;
    line_ = {middle - 0.5 * plateau, middle + 0.5 * plateau};
    if (line_.length() < kPoint * largest_diameter_) {
      check_line_long_enough(setup_, poured_);
      end_pour();
      return;
    }
    bottom += *std::max_element(surface.top.begin(), surface.top.end());
  }
  std::vector<ShapedGrain> layer;
  double room = line_.length();
  while (poured_ < setup_.source.grains && 2 * grains_[poured_].radius <= room) {
    room -= 2 * grains_[poured_].radius;
    layer.push_back(grains_[poured_++]);
  }
  for (NewGrain g :
       side_by_side(layer, line_.left, line_.right, bottom, setup_.material.density, random_)) {
    g.vy = -setup_.source.speed;
    engine_->add(g);
  }
  layer_start_ = phase_steps_;
  layer_grains_ = static_cast<int>(layer.size());
}

bool PileRun::settled(int grains) const {
  const double r = 0.5 * mean_diameter_;
  const double energy = setup_.material.density * total_area(grains_) / setup_.source.grains *
                        setup_.material.gravity * r;
  return engine_->motion().kinetic_energy <= kSettledShare * energy * grains;
}

void PileRun::end_pour() {
  pour_time_ = in_phase();
  enter(Phase::settle);
}

void PileRun::settle() {
  // The last grain is still in the air, and the pile sleeps: its energy counts as that of one.
  const double fall = std::sqrt(2 * kEntryMargin * mean_diameter_ / setup_.material.gravity);
  if (in_phase() < 2 * fall) return;
  if (!settled(1) && in_phase() < kMaxSettleTime) return;
  check_walls_free(setup_, engine_->snapshot(), largest_diameter_, 1);
  engine_->set_sleep(false);
  enter(Phase::rest);
}

void PileRun::rest() {
  const Diagnostics d = engine_->measure();
  if (at_rest(d, setup_.rest)) {
    at_pile_ = d;
    pile_ = named(engine_->snapshot(), "pile");
    check_not_leaning(setup_, *pile_);
    changes_->start_from(*pile_);
    enter(changes_->done() ? Phase::done : Phase::change);
  } else if (in_phase() > setup_.rest.max_time) {
    fail_to_rest(d, setup_.rest, "after the pour", smaller_step(setup_.motion));
  }
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
  if (changes_->done()) enter(Phase::done);
}

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
    case Phase::pour:
      p.phase = fmt::format("pour {}/{}", poured_, setup_.source.grains);
      p.fraction = 0.7 * poured_ / setup_.source.grains;
      break;
    case Phase::settle:
      p.phase = "settle";
      p.fraction = 0.7;
      break;
    case Phase::rest:
      p.phase = "rest";
      p.fraction = 0.7 + (end_of_rest - 0.7) * rest_progress(d, setup_.rest);
      break;
    case Phase::change:
      p.phase = changes_->phase();
      p.fraction = kEndOfRest + (1 - kEndOfRest) * changes_->fraction();
      break;
    case Phase::done:
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
      "pile {} {} {} {} {} {} {} [{}] | {} {} {} {} {} {} {} {} {} {} | {} {} | {} {} {} {} {} {} "
      "| "
      "{} | {} | {} | {} | {}",
      h.kind, h.radius, h.polydispersity, h.corners_min, h.corners_max, h.axis_ratio, h.side,
      fmt::join(h.outline, " "), o.kind, o.grains, o.speed, o.height, o.interval, o.spread, o.move,
      o.clearance, o.length, o.shift, setup_.floor.kind, setup_.floor.length, s.on, s.quiet_time,
      s.quiet_move, s.quiet_force, s.wake_force, s.wake_speed, changes_->describe(),
      describe(setup_.material), describe(setup_.motion, settings_.time_step),
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
  if (phase_ > Phase::rest) {
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
  f["dem.grains"] = engine_->grains();
  f["dem.contacts"] = at_pile_.contacts;
  f["dem.sliding_contacts"] = at_pile_.sliding;
  f["dem.steps"] = static_cast<double>(engine_->steps());
  f["dem.time_step"] = settings_.time_step;
  f["dem.unbalanced_force_ratio"] = at_pile_.unbalanced_force_ratio;
  f["dem.unbalanced_force_max_ratio"] = at_pile_.max_unbalanced_force / at_pile_.mean_contact_force;
  f["dem.kinetic_to_elastic_energy"] = at_pile_.kinetic_energy / at_pile_.elastic_energy;
  f["dem.max_overlap_ratio"] = at_pile_.max_overlap_ratio;
  f["pile.pour_time"] = pour_time_;
  f["pile.awake_mean"] =
      awake_samples_ > 0 ? awake_sum_ / static_cast<double>(awake_samples_) : engine_->grains();
  f["pile.grains_not_poured"] = setup_.source.grains - poured_;
  f["pile.mean_diameter"] = mean_diameter_;
  add_heap_figures(*pile_, mean_diameter_, f);
  changes_->add_to(out);
  return out;
}

}  // namespace

std::unique_ptr<Run> make_pile_run(const PileSetup& setup, std::uint64_t seed, int threads) {
  return std::make_unique<PileRun>(setup, seed, threads);
}

}  // namespace grainfield::dem
