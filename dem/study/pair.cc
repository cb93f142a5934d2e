// Free collisions: one after the other, each in an engine of its own, until the bodies part. Paths:
// one after the other, each passed again in finer steps until its work has settled.
#include "dem/study/pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "dem/space/lever.h"
#include "dem/space/rotation.h"
#include "dem/study/archive.h"
#include "dem/study/fingerprint.h"
#include "dem/study/pair_path.h"
#include "dem/study/pair_records.h"

namespace grainfield::dem {
namespace {

// An impact that takes longer than so many half periods of the contact counts as without end.
constexpr double kLongest = 2000;
// Speeds below this share of the whole are round-off.
constexpr double kNoSpeed = 1e-12;
// The work of a path has settled when finer steps change it by less than this share of the largest
// stored energy; steps are made finer by these factors.
constexpr double kSettled = 2e-6;
constexpr int kFiner = 4, kFinest = 256;
// Random loops during which the bodies overlap by less than this share of r^2 (of r: spheres) are
// drawn again.
constexpr double kHardlyMet = 0.01;
constexpr int kLookAt = 200;
constexpr double kBar = 4.8;  // axis ratio of those that lie across each other

/// Motion at the first touch, by which both restitutions are measured.
struct Touch {
  Vec3 normal{1, 0, 0}, arm_first{0, 0, 0}, arm_second{0, 0, 0};

  Vec3 velocity(const PairState& a, const PairState& b) const {
    return a.velocity + velocity_at(a.spin, arm_first) - b.velocity -
           velocity_at(b.spin, arm_second);
  }
};

struct Impact {
  double restitution_normal = 0, restitution_tangential = 0;
  double duration = 0, max_depth = 0, max_force = 0, lost = 0;
  int parted = 1;
};

PairState start_of(const PairBodies& bodies, const PairPose& pose, const PairLaunch& launch) {
  PairState out = bodies.state_of_first(pose);
  const auto [c, s] = rotation_of(launch.angle * std::numbers::pi / 180);
  out.velocity = launch.speed * Vec3(c, s, 0);
  return out;
}

/// Throws std::invalid_argument when they do not approach each other where they touch.
Touch touch_of(const PairBodies& bodies, const PairState& first) {
  const PairState second = bodies.state_of_second();
  const PairForces f = bodies.probe()->at(first, second, 0);
  Touch out;
  out.normal = f.normal;
  out.arm_first = f.point - first.position;
  if (!bodies.has_wall) out.arm_second = f.point - second.position;
  const double approach = out.velocity(first, second).dot(out.normal);
  if (!(approach > 0)) {
    throw std::invalid_argument(fmt::format(
        "pair.angle: the bodies move apart at {:.3g} m/s where they touch, allowed: angle, "
        "offset and spins with which they approach",
        -approach));
  }
  return out;
}

class PairRun : public ArchivedRun {
 public:
  PairRun(const PairSetup& setup, std::uint64_t seed, int threads)
      : setup_(setup), seed_(seed), threads_(threads) {
    check_pair(setup_);
  }

 protected:
  PairBodies draw() const {
    Random random(seed_);
    return make_pair(setup_, random, threads_);
  }
  std::string fingerprint() const override {
    return fmt::format("pair {} {}", fingerprint_of(setup_), seed_);
  }
  RunResult result_of(const PairBodies& bodies, long steps) const {
    RunResult out;
    out.snapshots = snapshots_of(records_, bodies);
    out.snapshots.front().second.attributes["seed"] = fmt::format("{}", seed_);
    out.figures = figures_;
    out.figures["dem.grains"] = bodies.has_wall ? 1 : 2;
    out.figures["dem.steps"] = static_cast<double>(steps);
    out.figures["pair.stable_time_step"] = bodies.stable_step;
    return out;
  }
  void add_figure(const std::string& key, double value) {
    if (std::isfinite(value)) figures_[key] = value;
  }
  void visit_figures(Archive& archive) {
    std::vector<double> values;
    std::string names;
    for (const auto& [key, value] : figures_) {
      names += key + "\n";
      values.push_back(value);
    }
    archive(names);
    archive(values);
    if (!archive.is_reading()) return;
    figures_.clear();
    std::size_t at = 0, k = 0;
    for (std::size_t end; (end = names.find('\n', at)) != std::string::npos; at = end + 1, ++k) {
      archive.require(k < values.size());
      figures_[names.substr(at, end - at)] = values[k];
    }
    archive.require(k == values.size());
  }

  PairSetup setup_;
  std::uint64_t seed_;
  int threads_;
  PairRecords records_;
  std::map<std::string, double> figures_;
};

class CollisionRun final : public PairRun {
 public:
  CollisionRun(const PairSetup& setup, std::uint64_t seed, int threads)
      : PairRun(setup, seed, threads), bodies_(draw()), launches_(pair_launches(setup_)) {
    pose_ = touching_pose(bodies_, setup_.offset * setup_.radius);
    for (const PairLaunch& launch : launches_) touch_of(bodies_, start_of(bodies_, pose_, launch));
    geometry_ = bodies_.probe();
    const double stiffness = std::visit(
        [&](const auto& law) { return law.stiffness(bodies_.first.radius); }, bodies_.settings.law);
    longest_ = kLongest * std::numbers::pi * std::sqrt(bodies_.pair_mass / stiffness);
    launch();
  }

  void advance(long steps) override {
    for (; steps > 0 && !done(); --steps) step();
  }
  bool done() const override { return at_ == static_cast<int>(launches_.size()); }
  Progress progress() const override {
    Progress p;
    p.phase = fmt::format("collision {}/{}", std::min<std::size_t>(at_ + 1, launches_.size()),
                          launches_.size());
    p.fraction = static_cast<double>(at_) / static_cast<double>(launches_.size());
    p.simulated_time = engine_->time();
    p.steps = steps_;
    p.grains = p.awake = engine_->grains();
    p.kinetic_energy = engine_->motion().kinetic_energy;
    return p;
  }
  RunResult result() const override {
    RunResult out = result_of(bodies_, steps_);
    out.figures["dem.time_step"] = bodies_.settings.time_step;
    return out;
  }

 private:
  void launch() {
    const PairState first = start_of(bodies_, pose_, launches_[at_]);
    before_first_ = first;
    before_second_ = bodies_.state_of_second();
    engine_ = bodies_.engine(first);
    kinetic_ = engine_->motion().kinetic_energy;
    impact_ = {};
    last_force_ = 0;
    // The first record: they touch, and nothing acts yet.
    if (at_ == 0) records_.add(record(), setup_.records);
  }
  PairRecord record() const {
    const Snapshot s = engine_->snapshot();
    PairRecord r;
    r.time = s.time;
    const auto state = [](const Grain& g, int dim) {
      PairState out;
      out.position = g.position;
      out.velocity = g.velocity;
      out.angle = g.angle;
      out.spin = dim == 3 ? g.angular_velocity : Vec3(0, 0, g.spin);
      out.orientation = g.orientation;
      return out;
    };
    r.first = state(s.grains[0], s.dim);
    if (!bodies_.has_wall) r.second = state(s.grains[1], s.dim);
    geometry_->forget();
    const PairForces shape = geometry_->at(r.first, r.second, 0);
    PairForces& f = r.forces;
    f.touching = shape.touching;
    f.normal = shape.normal;
    f.point = shape.point;
    f.depth = shape.depth;
    f.area = shape.area;
    f.chord = shape.chord;
    if (!s.contacts.empty()) {
      const Contact& c = s.contacts.front();
      f.normal = c.normal;
      f.point = c.point;
      f.force = c.force;
      f.normal_force = c.normal_force;
      f.tangential_force = c.tangential_force;
      const Vec3 turning = moment_of_springs(c);
      f.torque_first = torque_of(Vec3(c.point - r.first.position), c.force) + turning;
      if (!bodies_.has_wall)
        f.torque_second = -torque_of(Vec3(c.point - r.second.position), c.force) - turning;
    }
    const Diagnostics d = engine_->measure();
    r.kinetic = d.kinetic_energy;
    r.stored = d.elastic_energy;
    r.dissipated = kinetic_ - r.kinetic - r.stored;
    return r;
  }
  // On the first body, against rolling and twisting: of the springs, without their dashpots, N m.
  Vec3 moment_of_springs(const Contact& c) const {
    const double a = bodies_.first.radius, b = bodies_.second.radius;
    const double radius = bodies_.has_wall ? a : a * b / (a + b);
    return radius * c.normal.cross(c.rolling_spring) + c.twisting_spring * c.normal;
  }
  void step() {
    engine_->step(1);
    ++steps_;
    const PairRecord r = record();
    if (at_ == 0) records_.add(r, setup_.records);
    const double force = r.forces.normal_force, dt = bodies_.settings.time_step;
    impact_.max_depth = std::max(impact_.max_depth, r.forces.depth);
    impact_.max_force = std::max(impact_.max_force, force);
    if (force > 0) {
      impact_.duration = r.time;
      before_last_ = last_force_;
      last_force_ = force;
    }
    const bool long_enough = r.time > longest_;
    if (r.forces.touching && !long_enough) return;
    // The force goes on as it fell until it is 0.
    if (!r.forces.touching && before_last_ > last_force_) {
      impact_.duration += dt * std::min(1.0, last_force_ / (before_last_ - last_force_));
    }
    impact_.parted = r.forces.touching ? 0 : 1;
    finish(r);
  }
  void finish(const PairRecord& r) {
    const Touch touch = touch_of(bodies_, before_first_);
    const Vec3 before = touch.velocity(before_first_, before_second_);
    const Vec3 after = touch.velocity(r.first, r.second);
    const double approach = before.dot(touch.normal);
    impact_.restitution_normal = -after.dot(touch.normal) / approach;
    const Vec3 slip = before - approach * touch.normal;
    const double size = slip.norm();
    impact_.restitution_tangential = size > kNoSpeed * before.norm()
                                         ? -after.dot(slip) / (size * size)
                                         : std::numeric_limits<double>::quiet_NaN();
    impact_.lost = (r.dissipated + r.stored) / kinetic_;
    const std::string& name = launches_[at_].name;
    add_figure(name + "restitution_normal", impact_.restitution_normal);
    add_figure(name + "restitution_tangential", impact_.restitution_tangential);
    add_figure(name + "duration", impact_.duration);
    add_figure(name + "max_depth", impact_.max_depth);
    add_figure(name + "max_force", impact_.max_force);
    add_figure(name + "energy_lost", impact_.lost);
    add_figure(name + "parted", impact_.parted);
    if (++at_ < static_cast<int>(launches_.size())) launch();
  }
  void visit(Archive& archive) override {
    archive(at_);
    archive(steps_);
    archive(impact_);
    archive(kinetic_);
    archive(last_force_);
    archive(before_last_);
    archive(before_first_);
    archive(before_second_);
    records_.visit(archive);
    visit_figures(archive);
    archive.engine(engine_, [this] { return bodies_.empty_engine(); });
    archive.require(at_ >= 0 && at_ <= static_cast<int>(launches_.size()) && engine_ != nullptr);
  }

  PairBodies bodies_;
  std::vector<PairLaunch> launches_;
  PairPose pose_;
  std::unique_ptr<PairProbe> geometry_;
  std::unique_ptr<Engine> engine_;
  double longest_ = 0, kinetic_ = 0, last_force_ = 0, before_last_ = 0;
  PairState before_first_, before_second_;
  Impact impact_;
  int at_ = 0;
  long steps_ = 0;
};

class PathRun final : public PairRun {
 public:
  PathRun(const PairSetup& setup, std::uint64_t seed, int threads)
      : PairRun(setup, seed, threads), loops_(setup_.path == "random" ? setup_.loops : 1) {
    prepare();
    begin_pass();
  }

  void advance(long steps) override {
    for (; steps > 0 && !done(); --steps) step();
  }
  bool done() const override { return now_.loop == loops_; }
  Progress progress() const override {
    Progress p;
    p.phase = fmt::format("path {}/{}", std::min(now_.loop + 1, loops_), loops_);
    p.fraction = static_cast<double>(now_.loop) / loops_;
    p.steps = now_.steps;
    p.grains = p.awake = bodies_->has_wall ? 1 : 2;
    return p;
  }
  RunResult result() const override {
    RunResult out = result_of(*first_bodies_, now_.steps);
    if (setup_.path != "random") return out;
    for (std::size_t c = 0; c < std::size(kLoopColumns); ++c) {
      std::string text;
      for (std::size_t k = c; k < done_loops_.size(); k += std::size(kLoopColumns)) {
        text += fmt::format("{}{:.6g}", text.empty() ? "" : " ", done_loops_[k]);
      }
      out.snapshots.front().second.attributes[std::string("pair:") + kLoopColumns[c]] = text;
    }
    return out;
  }

 private:
  struct Now {
    int loop = 0, factor = 1, step = 0, most_crossings = 0;
    double work = 0, stored = 0, deepest = 0, before = 0, start_stored = 0;
    double worst = 0, sum = 0, crossing = 0, unsettled = 0;
    long steps = 0;
  };

  // Bodies and path of the present loop.
  void prepare() {
    if (setup_.path != "random") {
      bodies_ = draw();
      path_.emplace(setup_, *bodies_);
    } else {
      Random random(seed_ + 0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(now_.loop + 1));
      do {
        PairSetup s = setup_;
        const bool bars = s.shape == "rand1" && now_.loop % 4 == 3;
        if (bars) {
          s.corners = 4;
          s.axis_ratio = kBar;
        }
        bodies_ = make_pair(s, random, threads_);
        path_.emplace(s, random, bars);
      } while (!meets());
    }
    probe_ = bodies_->probe();
    if (now_.loop == 0) first_bodies_ = bodies_;
    length_ = path_->length(kLookAt);
  }
  bool meets() const {
    const std::unique_ptr<PairProbe> probe = bodies_->probe();
    for (int k = 0; k < kLookAt; ++k) {
      probe->forget();
      const PairForces f = probe->at(bodies_->state_of_first(path_->at((k + 0.5) / kLookAt)),
                                     bodies_->state_of_second(), 0);
      const double r = setup_.radius;
      if (setup_.in_space() ? f.depth > kHardlyMet * r : f.area > kHardlyMet * r * r) return true;
    }
    return false;
  }
  int count() const { return setup_.steps * now_.factor; }
  void begin_pass() {
    now_.step = 0;
    now_.work = now_.stored = now_.start_stored = now_.deepest = 0;
    probe_->forget();
    if (now_.loop == 0) records_ = {};
    const PairForces f =
        probe_->at(bodies_->state_of_first(path_->at(0)), bodies_->state_of_second(), 0);
    now_.start_stored = f.stored;
  }
  // By the midpoint rule: the forces in the middle of the step, on the way of the whole.
  void step() {
    const int n = count();
    const double dt = setup_.speed > 0 ? length_ / (setup_.speed * n) : 0;
    const PairPose begin = path_->at(static_cast<double>(now_.step) / n),
                   end = path_->at(static_cast<double>(now_.step + 1) / n),
                   middle = path_->at((now_.step + 0.5) / n);
    PairRecord r;
    r.first = bodies_->state_of_first(middle);
    r.second = bodies_->state_of_second();
    r.first.spin = r.second.spin = Vec3::Zero();
    const Vec3 way(end.x - begin.x, end.y - begin.y, 0);
    const double turn = end.angle - begin.angle;
    if (dt > 0) {
      r.first.velocity = way / dt;
      r.first.spin = {0, 0, turn / dt};
    }
    r.forces = probe_->at(r.first, r.second, dt);
    now_.work -= r.forces.force.dot(way) + r.forces.torque_first.z() * turn;
    now_.stored = std::max(now_.stored, r.forces.stored);
    now_.deepest = std::max(now_.deepest, r.forces.depth);
    if (now_.step % 50 == 0) {
      now_.most_crossings = std::max(now_.most_crossings, crossings(*bodies_, r.first, r.second));
    }
    ++now_.steps;
    if (now_.loop == 0) {
      r.time = (now_.step + 0.5) * dt;
      r.stored = r.forces.stored;
      r.dissipated = now_.work - (r.stored - now_.start_stored);
      records_.add(r, setup_.records);
    }
    if (++now_.step == n) end_pass();
  }
  void end_pass() {
    const bool settled =
        now_.factor > 1 && std::fabs(now_.work - now_.before) <= kSettled * now_.stored;
    if (!settled && now_.factor < kFinest) {
      now_.before = now_.work;
      now_.factor *= kFiner;
      return begin_pass();
    }
    if (!settled) ++now_.unsettled;
    end_loop();
  }
  void end_loop() {
    const double share = now_.stored > 0 ? now_.work / now_.stored : 0;
    if (now_.loop == 0) {
      add_figure("pair.work", now_.work);
      add_figure("pair.max_depth", now_.deepest);
      add_figure("pair.stored_most", now_.stored);
    }
    now_.worst = std::max(now_.worst, std::fabs(share));
    now_.sum += std::fabs(share);
    now_.crossing += now_.most_crossings > 2;
    for (const double value : {share, now_.stored, static_cast<double>(now_.most_crossings)}) {
      done_loops_.push_back(value);
    }
    if (++now_.loop < loops_) {
      now_.factor = 1;
      now_.before = now_.most_crossings = 0;
      prepare();
      return begin_pass();
    }
    add_figure("pair.loops", loops_);
    if (path_->closed()) {
      add_figure("pair.loop_work_over_energy", now_.worst);
      add_figure("pair.loop_work_over_energy_mean", now_.sum / loops_);
    }
    add_figure("pair.loops_crossing", now_.crossing);
    add_figure("pair.loops_unsettled", now_.unsettled);
  }
  void visit(Archive& archive) override {
    archive(now_);
    std::string memory = archive.is_reading() ? "" : probe_->image();
    archive(memory);
    archive(done_loops_);
    records_.visit(archive);
    visit_figures(archive);
    archive.require(now_.loop >= 0 && now_.loop <= loops_);
    if (!archive.is_reading()) return;
    if (!done()) prepare();  // the first bodies stay those of the constructor
    probe_->restore(memory);
  }

  int loops_;
  std::optional<PairBodies> bodies_, first_bodies_;
  std::optional<PairPath> path_;
  std::unique_ptr<PairProbe> probe_;
  double length_ = 0;
  Now now_;
  std::vector<double> done_loops_;  // kLoopColumns of one loop after the other
};

}  // namespace

std::vector<PairLaunch> pair_launches(const PairSetup& s) {
  std::vector<PairLaunch> out{{s.speed, s.angle, "pair."}};
  for (const double v : s.speeds) out.push_back({v, s.angle, fmt::format("pair.speed_{:g}.", v)});
  for (const double a : s.angles) out.push_back({s.speed, a, fmt::format("pair.angle_{:g}.", a)});
  return out;
}

std::unique_ptr<Run> make_pair_run(const PairSetup& setup, std::uint64_t seed, int threads) {
  if (setup.kind == "path") return std::make_unique<PathRun>(setup, seed, threads);
  return std::make_unique<CollisionRun>(setup, seed, threads);
}

Outlook foresee_pair(const PairSetup& setup, const std::vector<std::uint64_t>& seeds,
                     std::int64_t most) {
  Outlook out;
  check_pair(setup);
  // Only what is drawn differs from seed to seed.
  const bool drawn = setup.shape == "rand1" || (setup.kind == "path" && setup.path == "random");
  for (const std::uint64_t seed : seeds) {
    if (most-- <= 0) break;
    make_pair_run(setup, seed, 1);
    Random random(seed);
    const double step = make_pair(setup, random, 1).settings.time_step;
    if (out.time_step == 0) out.time_step = step;
    if (!drawn) break;
  }
  out.grains = setup.partner == "wall" ? 1 : 2;
  return out;
}

}  // namespace grainfield::dem
