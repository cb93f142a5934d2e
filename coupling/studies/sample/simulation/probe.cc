#include "coupling/studies/sample/simulation/probe.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "coupling/studies/sample/simulation/path.h"
#include "coupling/studies/sample/simulation/state.h"
#include "coupling/studies/sample/simulation/view.h"
#include "coupling/studies/sample/simulation/walls.h"

namespace grainfield::dem {
namespace {

// Steps between two looks at the rest.
constexpr long kProbeCheck = 200;
// A strain is imposed within this many times of the background damping, and in this many steps at
// least.
constexpr double kProbeTime = 2;
constexpr long kProbeSteps = 500;
// Calm: what is left of motion is this share of the probe's strain, by its energy (both over the
// strain that the pressure has made, which is the square root of the elastic energy); and the
// forces are balanced to this share of the probe's strain.
constexpr double kCalmMotion = 0.1, kCalmForces = 1;
// A sample whose elastic energy falls to this share of what it was has lost its load.
constexpr double kLostLoad = 1e-4;
// Kinetic over elastic energy must fall to this share within so many decay times of the damping,
// again and again, or grains count as moving for ever.
constexpr double kSlowest = 0.5, kPatience = 50;
// A wall of less friction carries no shear to speak of.
constexpr double kRoughWall = 0.1;
// Components of a strain.
constexpr std::uint64_t kMostDirections = 6;

std::pair<int, int> axes_of(const std::string& direction) {
  return {direction[0] - 'x', direction[1] - 'x'};
}

// The steps of a probe's motion.
long steps_of_probe(const SampleSetup& s, double time_step) {
  const double steps = std::ceil(kProbeTime / s.rest.background_damping / time_step);
  return std::max(kProbeSteps, static_cast<long>(steps));
}

// The contacts of a state, each with whether it slides.
std::map<std::tuple<std::int64_t, std::int64_t, std::array<int, 3>>, bool> contacts_of(
    const Snapshot& s) {
  std::map<std::tuple<std::int64_t, std::int64_t, std::array<int, 3>>, bool> out;
  for (const Contact& c : s.contacts) out[{c.i, c.j, c.image}] = c.sliding;
  return out;
}

void show(StateProbes& all, Archive& archive) {
  archive(all.state);
  archive(all.stress);
  archive(all.lacking);
  auto directions = static_cast<std::uint64_t>(all.probes.size());
  archive(directions);
  archive.require(directions <= kMostDirections);
  all.probes.resize(directions);
  for (Probe& probe : all.probes) {
    archive(probe.direction);
    archive(probe.outcomes);
  }
}

}  // namespace

std::vector<std::string> probe_directions(const SampleSetup& s) {
  if (is_periodic(s.plan)) return {"xx", "yy", "zz", "yz", "xz", "xy"};
  if (s.material.wall_friction >= kRoughWall) return {"xx", "yy", "zz", "xz"};
  return {"xx", "yy", "zz"};
}

double probe_time(const SampleSetup& s, double time_step) {
  const SamplePlan& p = s.plan;
  const int states = (probes_prepared(p) ? 1 : 0) + (probes_first(p) ? 1 : 0);
  if (states == 0) return 0;
  const double damping = s.rest.background_damping, look = kProbeCheck * time_step;
  const double one = static_cast<double>(steps_of_probe(s, time_step)) * time_step + look;
  // Free motion dies away with the whole rate of damping.
  const double calm =
      std::log(std::sqrt(s.rest.kinetic_to_elastic_energy) / (kCalmMotion * p.probe_strain)) /
      damping;
  const auto count = static_cast<double>(2 * probe_directions(s).size());
  return states * (std::max(look, calm) + count * one);
}

void SampleProber::begin(Engine& engine, const std::string& state, bool held) {
  state_ = state;
  origin_ = engine.checkpoint();
  energy_ = engine.measure().elastic_energy;
  number_ = -1;
  found_.emplace_back().state = state_;
  engine.set_background_damping(setup_.rest.background_damping);
  if (!held) stand_still(engine);
  enter(Stage::calm);
}

void SampleProber::enter(Stage stage) {
  stage_ = stage;
  steps_ = 0;
}

void SampleProber::stand_still(Engine& engine) const {
  if (is_periodic(setup_.plan)) {
    engine.set_velocity_gradient(Eigen::Matrix3d::Zero());
    return;
  }
  for (const Wall& wall : engine.walls()) engine.set_wall_motion(wall.name, WallMotion{});
}

void SampleProber::move(Engine& engine) {
  stand_still(engine);
  enter(Stage::move);
  const double dt = engine.time_step();
  move_ = steps_of_probe(setup_, dt);
  const std::string direction = probe_directions(setup_)[static_cast<std::size_t>(number_ / 2)];
  const auto [a, b] = axes_of(direction);
  const double strain = (number_ % 2 == 0 ? 1 : -1) * setup_.plan.probe_strain;
  const double rate = strain / (static_cast<double>(move_) * dt);
  if (is_periodic(setup_.plan)) {
    Eigen::Matrix3d flow = Eigen::Matrix3d::Zero();
    flow(a, b) = flow(b, a) = rate;
    engine.set_velocity_gradient(flow);
    return;
  }
  const Vec3 edges = sample_edges(setup_.plan, engine);
  WallMotion motion;
  if (a == b) {
    motion.velocity[a] = rate * edges[a];
    engine.set_wall_motion(moved_wall(a, 3), motion);
    return;
  }
  // Simple shear with the same symmetric part.
  motion.velocity.x() = 2 * rate * edges.z();
  engine.set_wall_motion("lid", motion);
  tilt_sides(engine, setup_.plan, 2 * strain, move_);
}

long SampleProber::until_due() const {
  return stage_ == Stage::move ? move_ - steps_ : kProbeCheck - steps_ % kProbeCheck;
}

bool SampleProber::is_calm(const Diagnostics& d) const {
  const double strain = setup_.plan.probe_strain, motion = kCalmMotion * strain;
  const double unbalanced = std::max(d.unbalanced_force_ratio, d.unbalanced_moment_ratio);
  return d.contacts > 0 && unbalanced <= kCalmForces * strain &&
         d.kinetic_energy <= motion * motion * d.elastic_energy;
}

bool SampleProber::decide(std::unique_ptr<Engine>& engine, long steps, const Make& make) {
  steps_ += steps;
  if (stage_ == Stage::move) {
    if (steps_ < move_) return false;
    stand_still(*engine);
    enter(Stage::hold);
    return false;
  }
  if (steps_ % kProbeCheck != 0) return false;
  const Diagnostics d = engine->measure();
  if (!is_calm(d)) {
    StateProbes none;
    none.state = state_;
    none.lacking = hopeless(d, engine->time_step());
    if (none.lacking.empty()) return false;
    found_.back() = none;
    give_back(engine, make);
    return true;
  }
  if (number_ < 0) {
    base_ = engine->checkpoint();
  } else {
    note(*engine, make);
  }
  ++number_;
  if (number_ == count()) {
    give_back(engine, make);
    return true;
  }
  engine = make();
  engine->restore(base_);
  move(*engine);
  return false;
}

void SampleProber::give_back(std::unique_ptr<Engine>& engine, const Make& make) {
  engine = make();
  engine->restore(origin_);
  origin_.clear();
  base_.clear();
}

// Why it will not be calm; "": it may still be.
std::string SampleProber::hopeless(const Diagnostics& d, double time_step) {
  if (d.elastic_energy < kLostLoad * energy_) {
    return fmt::format("it bears no load as its grains come to rest with a friction of {:g}",
                       setup_.material.friction);
  }
  const double unrest = d.kinetic_energy / d.elastic_energy;
  const double damping = setup_.rest.background_damping;
  const auto looks = static_cast<long>(kPatience / (damping * time_step * kProbeCheck)) + 1;
  const bool again = steps_ % (looks * kProbeCheck) == 0;
  const bool stuck = again && steps_ > looks * kProbeCheck && unrest > kSlowest * unrest_;
  if (again) unrest_ = unrest;
  if (!stuck && static_cast<double>(steps_) * time_step <= setup_.rest.max_time) return "";
  return fmt::format(
      "its grains do not come to rest for a strain of {:g}: after {:.3g} s, {:.0f} decay times of "
      "rest.background_damping, kinetic over elastic energy is {:.2g} and forces are balanced to "
      "{:.2g}{}",
      setup_.plan.probe_strain, static_cast<double>(steps_) * time_step,
      static_cast<double>(steps_) * time_step * damping, unrest,
      std::max(d.unbalanced_force_ratio, d.unbalanced_moment_ratio),
      setup_.material.law == "hertz_elliptic" && setup_.material.friction == 0
          ? "; without friction Hertz' elliptic law, which is no gradient, keeps them moving"
          : "");
}

void SampleProber::note(const Engine& engine, const Make& make) {
  const std::unique_ptr<Engine> calm = make();
  calm->restore(base_);
  const Snapshot before = calm->snapshot(), now = engine.snapshot();
  const SampleState was = sample_state(before), is = sample_state(now);
  ProbeOutcome out;
  out.gradient = is.edges * was.edges.inverse() - Eigen::Matrix3d::Identity();
  out.stress = is.contact_stress;
  const auto old = contacts_of(before), fresh = contacts_of(now);
  const double share = 1 / static_cast<double>(old.size());
  for (const auto& [pair, slides] : fresh) {
    const auto at = old.find(pair);
    if (at == old.end()) out.gained += share;
    if (at != old.end() && slides && !at->second) out.sliding += share;
  }
  for (const auto& [pair, slides] : old) out.lost += fresh.contains(pair) ? 0 : share;
  found_.back().stress = was.contact_stress;
  add_outcome(found_.back(), probe_directions(setup_)[static_cast<std::size_t>(number_ / 2)],
              number_, out);
}

double SampleProber::share() const { return std::max(0, number_) / static_cast<double>(count()); }

void SampleProber::visit(Archive& archive) {
  archive(state_);
  archive(origin_);
  archive(base_);
  archive(number_);
  archive(stage_);
  archive(steps_);
  archive(move_);
  archive(energy_);
  archive(unrest_);
  auto states = static_cast<std::uint64_t>(found_.size());
  archive(states);
  archive.require(states <= probed_states().size());
  found_.resize(states);
  for (StateProbes& one : found_) show(one, archive);
}

}  // namespace grainfield::dem
