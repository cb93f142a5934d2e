// Free collisions, one after the other, each in an engine of its own, until the bodies part.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/studies/pair/pair_run.h"
#include "dem/space/lever.h"
#include "dem/space/rotation.h"

namespace grainfield::dem {
namespace {

// After so many half periods of the contact bodies count as parted when nothing pushes them any
// more and they recede, overlap or not. An impact that then still goes on is ended after so many
// times its largest depth over the speed: that takes long under a soft law at small speeds, and up
// to 2 ln(2 b) such times under a dashpot b times the critical one.
constexpr double kLongest = 2000, kLongestFlight = 100;
// The engine bears no way in a step beyond this share of the radius.
constexpr double kMostWay = 0.5;
// Speeds below this share of the whole are round-off.
constexpr double kNoSpeed = 1e-12;

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

/// Normal and lever arms where they touch.
Touch touch_of(const PairBodies& bodies, const PairState& first) {
  const PairState second = bodies.state_of_second();
  const PairForces f = bodies.probe()->at(first, second, 0);
  Touch out;
  out.normal = f.normal;
  out.arm_first = f.point - first.position;
  if (!bodies.has_wall) out.arm_second = f.point - second.position;
  return out;
}

// Throws std::invalid_argument naming the launch's key when they do not approach each other where
// they touch: the approach is v cos(angle - phi) + w, phi the normal's angle and w that of the
// spins.
void check_approach(const PairBodies& bodies, const PairPose& pose, const PairLaunch& launch) {
  const PairState first = start_of(bodies, pose, launch), second = bodies.state_of_second();
  const Touch touch = touch_of(bodies, first);
  const double approach = touch.velocity(first, second).dot(touch.normal);
  if (approach > 0) return;
  constexpr double kDegree = std::numbers::pi / 180;
  const double phi = std::atan2(touch.normal.y(), touch.normal.x());
  const double along = std::cos(launch.angle * kDegree - phi);  // of the velocity to the normal
  const double spins = approach - launch.speed * along, share = -spins / launch.speed;
  const bool by_speed = launch.speed_key == "pair.speeds" || share >= 1;
  std::string allowed = "offset and spins with which they approach";
  if (by_speed && along > 0) {
    allowed = fmt::format("above {:.6g}", -spins / along);
  } else if (by_speed && spins > 0 && along < 0) {
    allowed = fmt::format("below {:.6g}", -spins / along);
  } else if (!by_speed) {
    const double half = std::acos(std::clamp(share, -1.0, 1.0));
    allowed = fmt::format("above {:.6g} and below {:.6g}", (phi - half) / kDegree,
                          (phi + half) / kDegree);
  }
  throw std::invalid_argument(fmt::format(
      "{}: found {:g}: the bodies move apart at {:.3g} m/s where they touch, allowed: {}",
      by_speed ? launch.speed_key : launch.angle_key, by_speed ? launch.speed : launch.angle,
      -approach, allowed));
}

// The same when the engine would lose the first body in its first step.
void check_way(const PairBodies& bodies, const PairLaunch& launch) {
  const double least =
      bodies.has_wall ? bodies.first.radius : std::min(bodies.first.radius, bodies.second.radius);
  const double most = kMostWay * least / bodies.settings.time_step;
  if (launch.speed <= most) return;
  throw std::invalid_argument(
      fmt::format("{}: found {:g}, allowed: at most {:.4g} m/s, half a radius in a time step of "
                  "{:.3g} s (motion.time_step)",
                  launch.speed_key, launch.speed, round_down(most), bodies.settings.time_step));
}

class CollisionRun final : public PairRun {
 public:
  CollisionRun(const PairSetup& setup, std::uint64_t seed, int threads)
      : PairRun(setup, seed, threads), bodies_(draw()), launches_(pair_launches(setup_)) {
    pose_ = touching_pose(bodies_, setup_.offset * setup_.radius);
    for (const PairLaunch& launch : launches_) {
      check_approach(bodies_, pose_, launch);
      check_way(bodies_, launch);
    }
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
    const bool parted = !r.forces.touching || (r.time > longest_ && force == 0 && recedes(r));
    const double flight = impact_.max_depth / launches_[at_].speed;
    if (!parted && r.time <= std::max(longest_, kLongestFlight * flight)) return;
    // The force goes on as it fell until it is 0.
    if (parted && before_last_ > last_force_) {
      impact_.duration += dt * std::min(1.0, last_force_ / (before_last_ - last_force_));
    }
    impact_.parted = parted ? 1 : 0;
    finish(r);
  }
  bool recedes(const PairRecord& r) const {
    return touch_of(bodies_, before_first_).velocity(r.first, r.second).dot(r.forces.normal) < 0;
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
    archive(figures_);
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

}  // namespace

std::unique_ptr<Run> make_collision_run(const PairSetup& setup, std::uint64_t seed, int threads) {
  return std::make_unique<CollisionRun>(setup, seed, threads);
}

}  // namespace grainfield::dem
